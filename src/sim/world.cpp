#include "sim/world.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "core/hash.hpp"

namespace brume::sim {
namespace {

constexpr std::uint32_t kMaxMilliseconds = 1u << 30;
/// A surface may carry smoke this far beyond the voxels that a cloud fills.
constexpr int kSmokeMargin = 2;

bool in_world(Position p) {
  return glm::all(
      glm::lessThanEqual(glm::abs(glm::max(p, Position(-kMaxCoordinate - 1))), Position(kMaxCoordinate)));
}

Failure bad(const std::string& what, const std::string& expected) {
  return {ErrorCode::bad_input, what + ": expected " + expected};
}

/// Checks what all events share: when, and from where to where.
Result<void> check_event(const std::string& name, std::uint32_t tick, Position from, Position to) {
  if (tick > kMaxTick)
    return bad(name + " at tick " + std::to_string(tick), "at most " + std::to_string(kMaxTick));
  if (!in_world(from) || !in_world(to))
    return bad(name + " at tick " + std::to_string(tick) + " with a position out of the world",
               "coordinates within 16384 m of the origin");
  return {};
}

bool inside(glm::ivec3 v, glm::ivec3 low, glm::ivec3 high) {
  return glm::all(glm::greaterThanEqual(v, low)) && glm::all(glm::lessThanEqual(v, high));
}

float seconds_from_ms(std::uint32_t ms) {
  return static_cast<float>(ms / 1000.0);
}

}  // namespace

World::World(const voxel::BitGrid& grid, const WorldSettings& settings)
    : grid_(grid), settings_(settings), ruler_(grid.frame()) {
  if (settings.ticks_per_second < 1 || settings.ticks_per_second > 1000)
    throw Error(ErrorCode::bad_input,
                std::to_string(settings.ticks_per_second) + " ticks a second: expected 1 to 1000");
}

Result<void> World::append(const ThrowSmoke& event) {
  if (auto ok = check_event("smoke", event.tick, event.from, event.at); !ok) return ok;
  if (event.smoke.voxels < 1 || event.smoke.voxels > kMaxFillVoxels)
    return bad("smoke of " + std::to_string(event.smoke.voxels) + " voxels",
               "1 to " + std::to_string(kMaxFillVoxels));
  if (event.smoke.bloom_ticks < 1 || event.smoke.bloom_ticks > kMaxTick)
    return bad("smoke that blooms in " + std::to_string(event.smoke.bloom_ticks) + " ticks",
               "1 to " + std::to_string(kMaxTick));

  Throw thrown{event, landing_voxel(grid_, ruler_, event.from, event.at), 0, nullptr};
  if (thrown.landing) {
    const std::uint64_t units = ceil_distance(event.from, ruler_.centre(*thrown.landing));
    const std::uint64_t speed = std::uint64_t{kGrenadeMetresPerSecond} * kUnitsPerMetre;
    thrown.detonation_tick =
        event.tick + static_cast<std::uint32_t>((units * settings_.ticks_per_second + speed - 1) / speed);
  }
  throws_.push_back(std::move(thrown));
  // A new smoke may lie on the way of any shot.
  for (Bullet& bullet : bullets_) bullet.distance.reset();
  advance_to(tick_);
  return {};
}

Result<void> World::append(const Shot& event) {
  if (auto ok = check_event("shot", event.tick, event.origin, event.toward); !ok) return ok;
  if (event.origin == event.toward)
    return bad("shot at tick " + std::to_string(event.tick) + " that goes nowhere",
               "origin and toward to differ");
  if (event.radius < 1 || event.radius > kMaxCoordinate)
    return bad("shot with radius " + std::to_string(event.radius), "1 to " + std::to_string(kMaxCoordinate));
  const HoleTiming& t = event.timing;
  if (std::max({t.reach_far, t.expand, t.stay_open, t.fade}) > kMaxMilliseconds)
    return bad("shot with a hole that takes too long",
               "at most " + std::to_string(kMaxMilliseconds) + " ms a time");
  bullets_.push_back({event, std::nullopt});
  advance_to(tick_);
  return {};
}

void World::detonate_until(std::uint32_t tick) {
  for (Throw& thrown : throws_)
    if (thrown.landing && !thrown.cloud && thrown.detonation_tick <= tick)
      thrown.cloud =
          std::make_unique<Cloud>(grid_, *thrown.landing, thrown.event.smoke, thrown.detonation_tick);
}

void World::advance_to(std::uint32_t tick) {
  tick_ = tick;
  detonate_until(tick);
  live_.clear();
  for (std::uint32_t id = 0; id < throws_.size(); ++id) {
    const Throw& thrown = throws_[id];
    if (thrown.cloud && thrown.detonation_tick <= tick)
      live_.push_back({id, thrown.cloud.get(), thrown.cloud->front(tick)});
  }
  for (Bullet& bullet : bullets_)
    if (!bullet.distance && bullet.event.tick <= tick) bullet.distance = hole_distance(bullet.event);
}

std::uint8_t World::density(glm::ivec3 voxel) const {
  unsigned sum = 0;
  for (const LiveCloud& live : live_)
    if (const auto distance = live.cloud->distance(voxel)) sum += Cloud::density_at(*distance, live.front);
  return static_cast<std::uint8_t>(std::min(sum, 255u));
}

std::optional<std::uint32_t> World::detonation_tick(std::uint32_t id) const {
  BRUME_ASSERT(id < throws_.size(), std::to_string(id));
  if (!throws_[id].landing) return std::nullopt;
  return throws_[id].detonation_tick;
}

std::optional<Grenade> World::grenade(std::uint32_t id, std::uint32_t tick) const {
  BRUME_ASSERT(id < throws_.size(), std::to_string(id));
  const Throw& thrown = throws_[id];
  if (!thrown.landing || tick < thrown.event.tick || tick >= thrown.detonation_tick) return std::nullopt;
  const double share =
      static_cast<double>(tick - thrown.event.tick) / (thrown.detonation_tick - thrown.event.tick);
  const glm::dvec3 from = metres_from_position(thrown.event.from);
  const glm::dvec3 to = metres_from_position(ruler_.centre(*thrown.landing));
  return Grenade{glm::vec3(glm::mix(from, to, share)), seconds(tick - thrown.event.tick)};
}

std::vector<Grenade> World::grenades() const {
  std::vector<Grenade> flying;
  for (std::uint32_t id = 0; id < throws_.size(); ++id)
    if (const auto one = grenade(id, tick_)) flying.push_back(*one);
  return flying;
}

std::uint64_t World::hole_distance(const Shot& shot) const {
  std::vector<const Cloud*> there;
  for (const Throw& thrown : throws_)
    if (thrown.cloud && thrown.detonation_tick <= shot.tick) there.push_back(thrown.cloud.get());
  if (there.empty()) return 0;

  Share far;
  bool was_free = false;
  walk_ray(grid_, ruler_, shot.origin, shot.toward, [&](const WalkStep& step) {
    const bool in_smoke = std::any_of(there.begin(), there.end(), [&](const Cloud* cloud) {
      return inside(step.voxel, cloud->low() - kSmokeMargin, cloud->high() + kSmokeMargin);
    });
    if (in_smoke) far = step.exit;
    was_free |= !grid_.solid(step.voxel);
    return !was_free || !grid_.solid(step.voxel);
  });
  const auto length = static_cast<__int128>(ceil_distance(shot.origin, shot.toward));
  return static_cast<std::uint64_t>(length * far.num / far.den);
}

bool World::is_open(const Bullet& bullet) const {
  const Shot& shot = bullet.event;
  if (tick_ <= shot.tick || bullet.distance.value_or(0) == 0) return false;
  const HoleTiming& t = shot.timing;
  const std::uint64_t life = std::uint64_t{t.reach_far} + t.expand + t.stay_open + t.fade;
  return std::uint64_t{tick_ - shot.tick} * 1000 < life * settings_.ticks_per_second;
}

shared::Hole World::make_hole(const Bullet& bullet) const {
  const Shot& shot = bullet.event;
  const glm::dvec3 from = metres_from_position(shot.origin);
  const glm::dvec3 forward = glm::normalize(metres_from_position(shot.toward) - from);
  // Right from the world's up, unless the shot goes nearly straight up or down.
  const glm::dvec3 up_world = std::abs(forward.y) < 0.999 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, up_world));
  shared::Hole hole{};
  hole.origin_world = glm::vec3(from);
  hole.radius = static_cast<float>(static_cast<double>(shot.radius) / kUnitsPerMetre);
  hole.forward = glm::vec3(forward);
  hole.right = glm::vec3(right);
  hole.up = glm::vec3(glm::cross(right, forward));
  hole.distance_to_far = static_cast<float>(static_cast<double>(*bullet.distance) / kUnitsPerMetre);
  hole.time_start = seconds(shot.tick);
  hole.time_to_reach_far = seconds_from_ms(shot.timing.reach_far);
  hole.time_to_expand = seconds_from_ms(shot.timing.expand);
  hole.time_to_stay_open = seconds_from_ms(shot.timing.stay_open);
  hole.time_to_fade = seconds_from_ms(shot.timing.fade);
  hole.shape = shared::kHoleCylinder;
  return hole;
}

std::vector<shared::Hole> World::holes() const {
  std::vector<shared::Hole> open;
  for (const Bullet& bullet : bullets_)
    if (is_open(bullet)) open.push_back(make_hole(bullet));
  return open;
}

std::uint64_t World::state_hash() const {
  std::vector<std::uint64_t> state{tick_, settings_.ticks_per_second};
  for (const LiveCloud& live : live_) state.insert(state.end(), {live.id, live.cloud->hash(), live.front});
  const auto add_position = [&](Position p) {
    for (int axis = 0; axis < 3; ++axis) state.push_back(static_cast<std::uint64_t>(std::int64_t{p[axis]}));
  };
  for (const Throw& thrown : throws_) {
    const bool flying = thrown.landing && tick_ >= thrown.event.tick && tick_ < thrown.detonation_tick;
    if (!flying) continue;
    add_position(thrown.event.from);
    add_position(*thrown.landing);
    state.insert(state.end(), {thrown.event.tick, thrown.detonation_tick});
  }
  for (const Bullet& bullet : bullets_) {
    if (!is_open(bullet)) continue;
    const Shot& shot = bullet.event;
    add_position(shot.origin);
    add_position(shot.toward);
    const HoleTiming& t = shot.timing;
    state.insert(state.end(),
                 {shot.tick, shot.radius, *bullet.distance, t.reach_far, t.expand, t.stay_open, t.fade});
  }
  return hash_values(std::span<const std::uint64_t>(state));
}

}  // namespace brume::sim
