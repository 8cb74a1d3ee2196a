#include "sim/state.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/hash.hpp"

namespace brume::sim {
namespace {

float seconds_from_ms(std::uint32_t ms) {
  return static_cast<float>(ms / 1000.0);
}

/// Gathers the numbers of a state for its hash.
class Words {
 public:
  template <typename... Numbers>
  void add(Numbers... numbers) {
    (words_.push_back(static_cast<std::uint64_t>(std::int64_t{numbers})), ...);
  }
  void add(std::uint64_t number) { words_.push_back(number); }
  void add(glm::ivec3 v) { add(v.x, v.y, v.z); }
  void add(float number) { words_.push_back(hash_values(std::span<const float>(&number, 1))); }
  void add(const SmokeSettings& s) { add(s.voxels, s.bloom_ticks, s.hold_ticks, s.dissolve_ticks); }
  std::uint64_t hash() const { return hash_values(std::span<const std::uint64_t>(words_)); }

 private:
  std::vector<std::uint64_t> words_;
};

void add_hole(Words& words, const OpenHole& hole) {
  const Shot& s = hole.shot;
  words.add(hole.id, s.tick, s.radius);
  words.add(s.origin);
  words.add(s.toward);
  words.add(s.timing.reach_far, s.timing.expand, s.timing.stay_open, s.timing.fade);
  words.add(static_cast<std::uint32_t>(s.shape), s.mask, s.roll);
  words.add(hole.distance);
}

/// Cosine and sine of an angle of 1/65536 turns, off by less than 10^-12. From additions and multiplications
/// alone: those of the standard library differ from one to the next.
glm::dvec2 cos_sin(std::uint32_t angle) {
  // The nearest quarter turn, and at most an eighth from there on.
  constexpr std::uint32_t kQuarter = kFullTurn / 4;
  const std::uint32_t quarters = (angle + kQuarter / 2) / kQuarter;
  const double x = (static_cast<double>(angle) - static_cast<double>(quarters * kQuarter)) *
                   (2 * std::numbers::pi / kFullTurn);
  const double y = x * x;
  // Taylor, up to x^14 and x^15: the next terms are below 0.786^16 / 16! = 10^-15.
  const auto series = [y](int first) {
    double sum = 1;
    for (int n = 12 + first; n >= 0; n -= 2) sum = 1 - y / ((n + 1) * (n + 2)) * sum;
    return sum;
  };
  const double c = series(0), s = x * series(1);
  switch (quarters % 4) {
    case 0:
      return {c, s};
    case 1:
      return {-s, c};
    case 2:
      return {-c, -s};
    default:
      return {s, -c};
  }
}

}  // namespace

std::uint8_t State::density(glm::ivec3 voxel) const {
  unsigned sum = 0;
  for (const LiveCloud& live : clouds) {
    const std::uint32_t rank = live.cloud->voxels().rank(voxel);
    if (rank != BlockSet::kNone) sum += live.cloud->density(rank, live.cloud->moment(tick));
  }
  auto density = static_cast<std::uint8_t>(std::min(sum, 255u));
  if (density == 0) return density;
  for (const LiveBlast& live : blasts)
    if (live.field->reached().contains(voxel))
      density = scaled_density(density, live.field->left(voxel, live.field->moment(tick)));
  return density;
}

std::uint64_t State::hash() const {
  Words words;
  words.add(frame.size);
  words.add(frame.voxel_size);
  for (int axis = 0; axis < 3; ++axis) words.add(frame.origin_world[axis]);
  words.add(ticks_per_second, tick, events, masks.count);
  words.add(masks.hash);
  words.add(std::uint64_t{edits ? edits->size() : 0});
  if (edits)
    for (const EditBlock& edit : *edits) {
      words.add(edit.at.x, edit.at.y, edit.at.z);
      words.add(edit.make_solid);
      words.add(edit.make_free);
    }
  words.add(std::uint64_t{flights.size()});
  for (const Flight& f : flights) {
    words.add(f.id, f.throw_tick, f.detonation_tick);
    words.add(f.from);
    words.add(f.landing);
    words.add(f.smoke);
  }
  words.add(std::uint64_t{clouds.size()});
  for (const LiveCloud& live : clouds) {
    const CloudMoment moment = live.cloud->moment(tick);
    words.add(live.id, moment.dissolved, moment.flowed);
    words.add(live.cloud->hash());
    words.add(moment.front);
  }
  words.add(std::uint64_t{blasts.size()});
  for (const LiveBlast& live : blasts) {
    words.add(live.id);
    words.add(live.field->hash());
  }
  words.add(std::uint64_t{holes.size()});
  for (const OpenHole& hole : holes) add_hole(words, hole);
  words.add(std::uint64_t{bodies.size()});
  for (const Body& b : bodies) {
    words.add(b.body, b.tick, b.previous_tick);
    words.add(b.position);
    words.add(b.previous);
  }
  return words.hash();
}

std::vector<Grenade> grenades_of(const State& state) {
  std::vector<Grenade> flying;
  const VoxelRuler ruler(state.frame);
  for (const Flight& f : state.flights) {
    const double share = static_cast<double>(state.tick - f.throw_tick) / (f.detonation_tick - f.throw_tick);
    const glm::dvec3 from = metres_from_position(f.from), to = metres_from_position(ruler.centre(f.landing));
    flying.push_back({glm::vec3(from + (to - from) * share), state.seconds(state.tick - f.throw_tick)});
  }
  return flying;
}

ShotAxes axes_of(const Shot& shot) {
  const glm::dvec3 forward =
      glm::normalize(metres_from_position(shot.toward) - metres_from_position(shot.origin));
  // Right from the world's up, unless the shot goes nearly straight up or down.
  const glm::dvec3 up_world = std::abs(forward.y) < 0.999 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, up_world)), up = glm::cross(right, forward);
  const glm::dvec2 turn = cos_sin(shot.roll);
  return {turn.x * right - turn.y * up, turn.x * up + turn.y * right, forward};
}

shared::Hole hole_of(const OpenHole& open, const State& state) {
  const Shot& shot = open.shot;
  const ShotAxes axes = axes_of(shot);
  shared::Hole hole{};
  hole.origin_world = glm::vec3(metres_from_position(shot.origin));
  hole.radius = static_cast<float>(static_cast<double>(shot.radius) / kUnitsPerMetre);
  hole.forward = glm::vec3(axes.forward);
  hole.right = glm::vec3(axes.right);
  hole.up = glm::vec3(axes.up);
  hole.distance_to_far = static_cast<float>(static_cast<double>(open.distance) / kUnitsPerMetre);
  hole.time_start = state.seconds(shot.tick);
  hole.time_to_reach_far = seconds_from_ms(shot.timing.reach_far);
  hole.time_to_expand = seconds_from_ms(shot.timing.expand);
  hole.time_to_stay_open = seconds_from_ms(shot.timing.stay_open);
  hole.time_to_fade = seconds_from_ms(shot.timing.fade);
  hole.shape = static_cast<shared::uint>(shot.shape);
  return hole;
}

std::vector<shared::Hole> holes_of(const State& state, const MaskAtlas* masks) {
  std::vector<shared::Hole> holes;
  for (const OpenHole& open : state.holes) {
    shared::Hole hole = hole_of(open, state);
    if (open.shot.shape == HoleShape::mask) {
      if (!masks || masks->key() != state.masks)
        throw Error(ErrorCode::bad_input,
                    "holes: the state was made with other masks; load the same timeline");
      hole.uv_min = masks->rectangle(open.shot.mask).uv_min;
      hole.uv_max = masks->rectangle(open.shot.mask).uv_max;
    }
    holes.push_back(hole);
  }
  return holes;
}

}  // namespace brume::sim
