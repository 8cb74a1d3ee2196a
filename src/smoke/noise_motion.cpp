#include "smoke/noise_motion.hpp"

#include <algorithm>
#include <cmath>

#include "core/portable_math.hpp"
#include "smoke/holes.hpp"

namespace brume::smoke {
namespace {

// A blooming cloud's noise is at most this much finer than when it is grown: what is finer the march misses.
constexpr double kMostGrown = 2.5;
// How the noise follows the front: a little behind, so that its cells grow too.
constexpr double kFollow = 0.8;
constexpr double kCreep = 1.0 / 7, kCreepSeconds = 5;
// How little of a dissolved cloud counts, so that nothing jumps when it goes: 1 less this.
constexpr double kGoneWeight = 0.999;
// How much wider the rolls of a cloud become while it dissolves.
constexpr double kDrawnOut = 2;
// How far the rolls of an old cloud are ahead of a new one's, in turns, and how fast they get there
// [s].
constexpr double kSwirlLead = 0.5, kSwirlLeadSeconds = 1.5;

/// 3x^2 - 2x^3, x clamped to [0, 1].
double smooth(double x) {
  const double c = std::clamp(x, 0.0, 1.0);
  return c * c * (3 - 2 * c);
}

/// 0 before, rises to 1, and is 0 again after `length`.
double pulse(double age, double rise, double length) {
  return smooth(age / rise) * (1 - smooth((age - rise) / std::max(length - rise, 1e-6)));
}

/// How far the front of a cloud is at a time between ticks [voxels].
double front_voxels(const sim::Cloud& cloud, double tick) {
  const double low = std::floor(std::max(tick, 0.0));
  const auto at = [&](double t) {
    return static_cast<double>(cloud.undissolved_phase(static_cast<std::uint32_t>(t)).front) /
           (static_cast<double>(sim::kFrontUnit) * sim::kFaceStep);
  };
  const double first = at(low);
  return first + (std::max(tick, 0.0) - low) * (at(low + 1) - first);
}

void add_shot(const sim::BulletHole& open, const sim::State& state, double seconds,
              FrameVector<shared::Impulse>& out) {
  const shared::Hole hole = make_hole(open, state);
  const double age = seconds - static_cast<double>(hole.time_start);
  const double length = static_cast<double>(hole.time_to_reach_far) +
                        static_cast<double>(hole.time_to_expand) +
                        static_cast<double>(hole.time_to_stay_open) + static_cast<double>(hole.time_to_fade);
  const auto strength = static_cast<float>(pulse(age, 0.15, length));
  if (strength <= 0) return;
  const double reached =
      std::clamp(age / std::max(static_cast<double>(hole.time_to_reach_far), 1e-6), 0.0, 1.0);
  shared::Impulse impulse{};
  impulse.from_world = hole.origin_world;
  impulse.to_world = hole.origin_world + hole.forward * (hole.distance_to_far * static_cast<float>(reached));
  impulse.radius = 3 * hole.radius;
  impulse.along = hole.forward * (2 * hole.radius * strength);
  impulse.outward = hole.radius * strength;
  out.push_back(impulse);
}

void add_blast(const sim::BlastField& field, const sim::State& state, double seconds,
               FrameVector<shared::Impulse>& out) {
  const auto& event = field.event();
  const double length = static_cast<double>(field.end_tick() - event.tick) / state.ticks_per_second;
  const auto strength =
      static_cast<float>(pulse(seconds - static_cast<double>(state.seconds(event.tick)), 0.2, length));
  if (strength <= 0) return;
  shared::Impulse impulse{};
  impulse.from_world = impulse.to_world = glm::vec3(sim::metres_from_position(field.centre()));
  impulse.radius = 1.5f * static_cast<float>(event.radius) / static_cast<float>(sim::kUnitsPerMetre);
  impulse.outward = 0.25f * impulse.radius * strength;
  out.push_back(impulse);
}

void add_body(const sim::Body& body, const sim::State& state, double seconds,
              FrameVector<shared::Impulse>& out) {
  if (body.tick <= body.previous_tick || body.position == body.previous) return;
  const glm::dvec3 to = sim::metres_from_position(body.position);
  const glm::dvec3 step = to - sim::metres_from_position(body.previous);
  const double taken = static_cast<double>(body.tick - body.previous_tick) / state.ticks_per_second;
  const double speed = glm::length(step) / taken;
  const double strength = 1 - smooth((seconds - static_cast<double>(state.seconds(body.tick))) / 1.5);
  if (strength <= 0) return;
  // What it passed shortly before follows it.
  const glm::dvec3 forward = glm::normalize(step);
  shared::Impulse impulse{};
  impulse.to_world = glm::vec3(to);
  impulse.from_world = glm::vec3(to - forward * std::min(0.5 * speed, 3.0));
  impulse.radius = 0.9f;
  impulse.along = glm::vec3(forward * (strength * std::min(0.15 * speed, 0.6)));
  impulse.outward = static_cast<float>(strength * std::min(0.1 * speed, 0.4));
  out.push_back(impulse);
}

}  // namespace

shared::CloudMotion cloud_motion(const sim::Cloud& cloud, std::uint32_t ticks_per_second, double seconds,
                                 double swirl_period) {
  const sim::CloudOrigin& origin = cloud.origin();
  const double tick = seconds * ticks_per_second;
  const double age = std::max(0.0, tick - origin.detonation_tick) / ticks_per_second;

  // How much finer the noise is than when the cloud is grown.
  const double grown =
      front_voxels(cloud, static_cast<double>(origin.detonation_tick) + origin.settings.bloom_ticks);
  const double now = std::max(front_voxels(cloud, tick), 1e-3);
  const double finer = std::min(portable::pow(std::max(grown / now, 1.0), kFollow), kMostGrown);
  const double creep = kCreep * (1 - portable::exp(-age / kCreepSeconds));

  // The rolls of all clouds keep pace, so that they blend where clouds meet; a new one's are only ahead.
  const double ahead = kSwirlLead * (1 - portable::exp(-age / kSwirlLeadSeconds));
  const auto [sine, cosine] = portable::sine_cosine_of_turns(
      std::fmod(seconds / std::max(swirl_period, kMinSwirlPeriod), 1.0) + ahead);
  // What dissolves is drawn out.
  const double dissolve = (tick - static_cast<double>(origin.detonation_tick) - origin.settings.bloom_ticks -
                           origin.settings.hold_ticks) /
                          origin.settings.dissolve_ticks;
  const double wide = 1 + kDrawnOut * smooth(dissolve);
  return {static_cast<float>(finer - 1 - creep), static_cast<float>(wide * cosine),
          static_cast<float>(wide * sine), static_cast<float>(now),
          static_cast<float>(1 - kGoneWeight * smooth(dissolve))};
}

FrameVector<shared::Impulse> make_impulses(const sim::State& state, double seconds, Allocator memory) {
  FrameVector<shared::Impulse> impulses(memory);
  const std::size_t shots = std::min(state.holes.size(), kMaxImpulses);
  for (const sim::BulletHole& open : std::span(state.holes).last(shots))
    add_shot(open, state, seconds, impulses);
  for (const sim::Body& body : state.bodies) add_body(body, state, seconds, impulses);
  for (const sim::LiveBlast& live : state.blasts) add_blast(*live.field, state, seconds, impulses);
  if (impulses.size() > kMaxImpulses)
    impulses.erase(impulses.begin(), impulses.end() - static_cast<std::ptrdiff_t>(kMaxImpulses));
  return impulses;
}

glm::vec3 NoiseMotion::by_impulses(glm::vec3 p_world) const {
  // Noise that moved along is read where it was.
  glm::vec3 sum(0);
  for (const shared::Impulse& impulse : impulses) sum -= shared::impulse_displacement(impulse, p_world);
  return sum;
}

NoiseMotion noise_motion(const sim::State& state, double seconds, double swirl_period, Allocator memory) {
  NoiseMotion motion{FrameVector<shared::CloudMotion>(memory), make_impulses(state, seconds, memory)};
  motion.clouds.reserve(state.clouds.size());
  for (const sim::LiveCloud& live : state.clouds)
    motion.clouds.push_back(cloud_motion(*live.cloud, state.ticks_per_second, seconds, swirl_period));
  return motion;
}

}  // namespace brume::smoke
