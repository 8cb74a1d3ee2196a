#include "tests/determinism/match.hpp"

#include <algorithm>

#include "sim/level_edit.hpp"
#include "voxel/voxelize.hpp"

namespace brume::determinism {
namespace {

constexpr voxel::GridLayout kFrame{{97, 15, 97}, 0.5f, {-24.25f, -0.75f, -24.25f}};

/// Converts from decimetres, the unit of the plan below.
glm::vec3 metres(glm::ivec3 tenths) {
  return glm::vec3(tenths) / 10.0f;
}

/// The 12 triangles of a box.
void add_box(std::vector<voxel::Triangle>& out, glm::ivec3 low, glm::ivec3 high) {
  for (int axis = 0; axis < 3; ++axis)
    for (const bool upper : {false, true}) {
      glm::ivec3 corner[4];
      for (int i = 0; i < 4; ++i) {
        corner[i][axis] = upper ? high[axis] : low[axis];
        corner[i][(axis + 1) % 3] = i == 1 || i == 2 ? high[(axis + 1) % 3] : low[(axis + 1) % 3];
        corner[i][(axis + 2) % 3] = i >= 2 ? high[(axis + 2) % 3] : low[(axis + 2) % 3];
      }
      out.push_back({metres(corner[0]), metres(corner[1]), metres(corner[2])});
      out.push_back({metres(corner[0]), metres(corner[2]), metres(corner[3])});
    }
}

/// A wall across the level, 0.2 m thick and 6 m high, perpendicular to `axis` at `place`. Openings are 2 m
/// wide and 2.5 m high and begin at these positions along the wall.
void add_wall(std::vector<voxel::Triangle>& out, int axis, int place, const std::vector<int>& openings) {
  const auto piece = [&](int from, int to, int bottom) {
    if (from >= to) return;
    glm::ivec3 low(0, bottom, 0), high(0, 60, 0);
    low[axis] = place - 1;
    high[axis] = place + 1;
    low[2 - axis] = from;
    high[2 - axis] = to;
    add_box(out, low, high);
  };
  int from = -240;
  for (const int opening : openings) {
    piece(from, opening, 0);
    piece(opening, opening + 20, 25);
    from = opening + 20;
  }
  piece(from, 240, 0);
}

/// A door fills the voxels of an opening.
struct Door {
  glm::ivec3 low, high;
};
// In the wall at x = -8 m before z = -1..1 m, and in the wall at z = 8 m before x = -1..1 m.
constexpr Door kDoors[2] = {{{32, 2, 47}, {33, 7, 50}}, {{47, 2, 64}, {50, 7, 65}}};

void add_smokes(std::vector<sim::Event>& events, Random& random) {
  // Two in one room, one on each side of a door, one on the stairs, the others at random positions.
  const std::vector<glm::ivec3> targets{{-12, 0, 0}, {-15, 0, 2}, {-3, 0, 0}, {0, 0, 5}, {16, 0, -16}};
  for (std::uint32_t i = 0; i < 8; ++i) {
    sim::ThrowSmoke smoke;
    smoke.tick = 10 + 110 * i;
    smoke.at =
        i < targets.size() ? targets[i] * sim::kUnitsPerMetre : random.position(kLowCorner, kHighCorner);
    smoke.from = smoke.at + random.position({-3000, 1600, -3000}, {3000, 1600, 3000});
    smoke.smoke.voxels = i % 3 == 2 ? 900 : 1800;
    smoke.smoke.hold_ticks = i % 2 == 0 ? 1152 : 500;
    events.emplace_back(smoke);
  }
}

constexpr std::uint32_t kMaskCount = 4;

void add_shots(std::vector<sim::Event>& events, Random& random) {
  for (int i = 0; i < 200; ++i) {
    sim::Shot shot;
    shot.tick = static_cast<std::uint32_t>(random.between(60, 1850));
    shot.origin = random.position(kLowCorner, kHighCorner);
    shot.toward = random.position(kLowCorner, kHighCorner);
    shot.radius = static_cast<std::uint32_t>(random.between(50, 500));
    if (i % 4 == 0) shot.timing = {100, 20, static_cast<std::uint32_t>(random.between(0, 4000)), 700};
    shot.shape = static_cast<sim::HoleShape>(i % 3);
    if (shot.shape == sim::HoleShape::mask) shot.mask = static_cast<std::uint32_t>(i) / 3 % kMaskCount;
    if (shot.shape != sim::HoleShape::cylinder)
      shot.roll = static_cast<std::uint32_t>(random.between(0, 65535));
    if (shot.origin != shot.toward) events.emplace_back(shot);
  }
}

void add_blasts(std::vector<sim::Event>& events, Random& random) {
  const glm::ivec3 places[5] = {{-10, 1, 1}, {-3, 1, 0}, {1, 2, 7}, {15, 2, -15}, {6, 1, 6}};
  for (std::uint32_t i = 0; i < 5; ++i) {
    sim::Blast blast;
    blast.tick = 190 + 170 * i;
    blast.at = places[i] * sim::kUnitsPerMetre;
    blast.radius = static_cast<std::uint32_t>(random.between(2000, 6000));
    blast.remaining = static_cast<std::uint32_t>(random.between(0, 60));
    events.emplace_back(blast);
  }
}

void add_moves(std::vector<sim::Event>& events, Random& random) {
  for (std::uint32_t body = 0; body < 4; ++body) {
    sim::Position at = random.position(kLowCorner, kHighCorner);
    for (std::uint32_t tick = body; tick < kMatchTicks; tick += 8) {
      at += random.position(glm::ivec3(-600, 0, -600), glm::ivec3(600, 0, 600));
      at = glm::clamp(at, kLowCorner, kHighCorner);
      events.emplace_back(sim::MoveBody{tick, 10 * body + 3, at});
    }
  }
}

void add_doors(std::vector<sim::Event>& events, const voxel::GridLayout& layout) {
  // Closed at first; opened, closed and opened again with smoke in front of them.
  for (std::uint32_t i = 0; i < 2; ++i)
    for (const std::uint32_t tick : {0u, 200u, 560u, 900u}) {
      const bool shut = tick == 0 || tick == 560;
      events.emplace_back(
          sim::LevelEdit{tick + 37 * i, sim::edit_box(layout, kDoors[i].low, kDoors[i].high, shut)});
    }
}

}  // namespace

const glm::ivec3 kLowCorner = glm::ivec3(-23, 0, -23) * sim::kUnitsPerMetre + glm::ivec3(0, 200, 0);
const glm::ivec3 kHighCorner = glm::ivec3(23, 5, 23) * sim::kUnitsPerMetre;

std::uint64_t Random::next() {
  std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
  z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
  z = (z ^ z >> 27) * 0x94d049bb133111ebu;
  return z ^ z >> 31;
}

int Random::between(int low, int high) {
  return low + static_cast<int>(next() % static_cast<std::uint64_t>(high - low + 1));
}

sim::Position Random::position(glm::ivec3 low, glm::ivec3 high) {
  sim::Position p;
  for (int axis = 0; axis < 3; ++axis) p[axis] = between(low[axis], high[axis]);
  return p;
}

MatchLevel make_level() {
  std::vector<voxel::Triangle> triangles;
  add_box(triangles, {-240, -5, -240}, {240, 0, 240});
  add_box(triangles, {-240, 60, -240}, {240, 62, 240});
  for (int axis = 0; axis < 3; axis += 2) {
    add_wall(triangles, axis, -239, {});
    add_wall(triangles, axis, 239, {});
  }
  add_wall(triangles, 0, -80, {-170, -10, 120});
  add_wall(triangles, 0, 80, {-160, 100});
  add_wall(triangles, 2, -80, {-200, 110});
  add_wall(triangles, 2, 80, {-170, -10, 150});
  // A corridor 2 m wide along the northern wall of the middle room; stairs; a slope oblique to all axes.
  add_box(triangles, {-80, 0, -62}, {60, 30, -60});
  for (int step = 0; step < 10; ++step)
    add_box(triangles, {120 + 5 * step, 0, -200}, {125 + 5 * step, 3 * (step + 1), -120});
  triangles.push_back({metres({-200, 0, 100}), metres({-110, 0, 130}), metres({-160, 45, 210})});
  voxel::BitGrid grid = voxel::voxelize(triangles, kFrame).value_or_throw();
  voxel::SurfacePlanes planes = voxel::SurfacePlanes::build(triangles, grid);
  return {std::move(grid), std::move(planes)};
}

smoke::MaskAtlas make_masks() {
  Random random(5);
  std::vector<smoke::Mask> masks;
  for (std::uint32_t i = 0; i < kMaskCount; ++i) {
    smoke::Mask mask{7 + 3 * i, 5 + 2 * i, {}};
    for (std::uint32_t t = 0; t < mask.width * mask.height; ++t)
      mask.texels.push_back(static_cast<std::uint8_t>(std::clamp(random.between(-128, 384), 0, 255)));
    masks.push_back(std::move(mask));
  }
  return smoke::MaskAtlas::pack(masks).value_or_throw();
}

std::vector<sim::Event> make_events(const voxel::GridLayout& layout) {
  Random random(3);
  std::vector<sim::Event> events;
  add_smokes(events, random);
  add_shots(events, random);
  add_blasts(events, random);
  add_moves(events, random);
  add_doors(events, layout);
  std::stable_sort(events.begin(), events.end(), [](const sim::Event& a, const sim::Event& b) {
    return sim::tick_of(a) < sim::tick_of(b);
  });
  return events;
}

}  // namespace brume::determinism
