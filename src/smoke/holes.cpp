#include "smoke/holes.hpp"

#include <cmath>
#include <numbers>

namespace brume::smoke {
namespace {

float seconds_from_ms(std::uint32_t ms) {
  return static_cast<float>(ms / 1000.0);
}

/// Cosine and sine of an angle of 1/65536 turns, with an error below 10^-12. From additions and
/// multiplications alone: standard libraries differ in theirs.
glm::dvec2 cos_sin(std::uint32_t angle) {
  // The nearest quarter turn, and up to an eighth from there.
  constexpr std::uint32_t kQuarter = sim::kFullTurn / 4;
  const std::uint32_t quarters = (angle + kQuarter / 2) / kQuarter;
  const double x = (static_cast<double>(angle) - static_cast<double>(quarters * kQuarter)) *
                   (2 * std::numbers::pi / sim::kFullTurn);
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

ShotAxes axes_of(const sim::Shot& shot) {
  const glm::dvec3 forward =
      glm::normalize(sim::metres_from_position(shot.toward) - sim::metres_from_position(shot.origin));
  // Right from the world's up, unless the shot goes nearly straight up or down.
  const glm::dvec3 up_world = std::abs(forward.y) < 0.999 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, up_world)), up = glm::cross(right, forward);
  const glm::dvec2 turn = cos_sin(shot.roll);
  return {turn.x * right - turn.y * up, turn.x * up + turn.y * right, forward};
}

shared::Hole make_hole(const sim::BulletHole& open, const sim::State& state) {
  const sim::Shot& shot = open.shot;
  const ShotAxes axes = axes_of(shot);
  shared::Hole hole{};
  hole.origin_world = glm::vec3(sim::metres_from_position(shot.origin));
  hole.radius = static_cast<float>(static_cast<double>(shot.radius) / sim::kUnitsPerMetre);
  hole.forward = glm::vec3(axes.forward);
  hole.right = glm::vec3(axes.right);
  hole.up = glm::vec3(axes.up);
  hole.distance_to_far = static_cast<float>(static_cast<double>(open.distance) / sim::kUnitsPerMetre);
  hole.time_start = state.seconds(shot.tick);
  hole.time_to_reach_far = seconds_from_ms(shot.timing.reach_far);
  hole.time_to_expand = seconds_from_ms(shot.timing.expand);
  hole.time_to_stay_open = seconds_from_ms(shot.timing.stay_open);
  hole.time_to_fade = seconds_from_ms(shot.timing.fade);
  hole.shape = static_cast<shared::uint>(shot.shape);
  return hole;
}

std::vector<shared::Hole> make_holes(const sim::State& state, const MaskAtlas* masks) {
  std::vector<shared::Hole> holes;
  for (const sim::BulletHole& open : state.holes) {
    shared::Hole hole = make_hole(open, state);
    if (open.shot.shape == sim::HoleShape::mask) {
      if (!masks || masks->key() != state.masks)
        throw Error(ErrorCode::bad_input, "holes: the state has other masks; load the same timeline");
      hole.uv_min = masks->rectangle(open.shot.mask).uv_min;
      hole.uv_max = masks->rectangle(open.shot.mask).uv_max;
    }
    holes.push_back(hole);
  }
  return holes;
}

}  // namespace brume::smoke
