#include "smoke/smoke_volume.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <tuple>

#include "voxel/voxelize.hpp"

namespace brume::smoke {
namespace {

using voxel::BitGrid;
using voxel::Triangle;

void add_quad(std::vector<Triangle>& mesh, glm::vec3 corner, glm::vec3 u, glm::vec3 v) {
  mesh.push_back({corner, corner + u, corner + u + v});
  mesh.push_back({corner, corner + u + v, corner + v});
}

/// A room with a slanted roof, an inner wall with a door, and open air around.
std::vector<Triangle> make_hut() {
  std::vector<Triangle> mesh;
  add_quad(mesh, {2, 0.3f, 2}, {9, 0, 0}, {0, 0, 8});
  add_quad(mesh, {2, 0.3f, 2}, {9, 0, 0}, {0, 3, 0});
  add_quad(mesh, {2, 0.3f, 10}, {9, 0, 0}, {0, 3, 0});
  add_quad(mesh, {2, 0.3f, 2}, {0, 3, 0}, {0, 0, 8});
  add_quad(mesh, {2, 3.3f, 2}, {9, 1.5f, 0}, {0, 0, 8});
  add_quad(mesh, {6.2f, 0.3f, 2}, {0, 3.4f, 0}, {0, 0, 5});
  return mesh;
}

sim::Position at(double x, double y, double z) {
  return sim::position_from_metres({x, y, z});
}

sim::World world_of(const BitGrid& grid, const std::vector<sim::Event>& events) {
  sim::World world(grid);
  for (const sim::Event& event : events) world.append(event).value_or_throw();
  return world;
}

struct Hut {
  std::vector<Triangle> mesh = make_hut();
  BitGrid grid = voxel::voxelize(mesh, {{29, 13, 25}, 0.5f, glm::vec3(0)}).value_or_throw();
  voxel::SurfacePlanes planes = voxel::SurfacePlanes::build(mesh, grid);

  /// Three smokes, two that overlap; three blasts, two that overlap; a hole in a wall, closed again.
  sim::World world() const {
    const glm::ivec3 low(12, 1, 6), high(13, 5, 11);
    return world_of(
        grid, {sim::ThrowSmoke{0, at(4, 1.5, 4), at(4, 1.4, 8), {900, 64, 100, 60}},
               sim::ThrowSmoke{50, at(8, 1.5, 9), at(8, 1.4, 3), {500, 40, 70, 40}},
               sim::ThrowSmoke{60, at(12, 2, 12), at(13, 1, 11), {700, 40, 90, 50}},
               sim::Blast{.tick = 80, .at = at(4, 1.5, 6), .radius = 3 * 1024, .refill_middle_ms = 900},
               sim::Blast{.tick = 85, .at = at(5, 1.5, 7), .radius = 2 * 1024, .refill_middle_ms = 700},
               sim::Blast{.tick = 120, .at = at(9, 1.5, 5), .radius = 2 * 1024, .refill_middle_ms = 700},
               sim::LevelEdit{70, sim::edit_box(grid.layout(), low, high, false)},
               sim::LevelEdit{130, sim::edit_box(grid.layout(), low, high, true)}});
  }
};
constexpr std::uint32_t kAllOver = 290;

bool same_planes(const shared::BoundaryCell& a, const shared::BoundaryCell& b) {
  return a.plane0 == b.plane0 && a.plane1 == b.plane1 && a.plane2 == b.plane2;
}

/// The same at each place, whatever numbers slots and cells have.
void expect_same(const SmokeVolume& a, const SmokeVolume& b) {
  EXPECT_EQ(a.layout().bricks.window_origin, b.layout().bricks.window_origin);
  EXPECT_EQ(a.layout().bricks.window_size, b.layout().bricks.window_size);
  EXPECT_EQ(a.layout().bounds_min, b.layout().bounds_min);
  EXPECT_EQ(a.layout().bounds_max, b.layout().bounds_max);
  const glm::ivec3 low = 8 * a.layout().bricks.window_origin, size = 8 * a.layout().bricks.window_size;
  for (int i = 0; i < size.x * size.y * size.z; ++i) {
    const glm::ivec3 brick = low + glm::ivec3(i % size.x, i / size.x % size.y, i / size.x / size.y);
    const std::uint32_t slot_a = a.slot_at(brick), slot_b = b.slot_at(brick);
    ASSERT_EQ(slot_a == SmokeVolume::kNoSlot, slot_b == SmokeVolume::kNoSlot);
    if (slot_a == SmokeVolume::kNoSlot) continue;
    EXPECT_EQ(a.brick_of(slot_a), brick);
    ASSERT_TRUE(std::ranges::equal(a.texels(slot_a), b.texels(slot_b)));
    for (std::size_t cell = 0; cell < shared::kCellsPerBrick; ++cell) {
      const std::uint32_t entry_a = a.cells(slot_a)[cell], entry_b = b.cells(slot_b)[cell];
      ASSERT_EQ(entry_a == 0, entry_b == 0) << brick.x << ' ' << brick.y << ' ' << brick.z << ' ' << cell;
      if (entry_a == 0) continue;
      const shared::BoundaryCell& cell_a = a.boundary_cells()[entry_a - 1];
      const shared::BoundaryCell& cell_b = b.boundary_cells()[entry_b - 1];
      ASSERT_TRUE(same_planes(cell_a, cell_b));
      const unsigned planes = unsigned{cell_a.plane0 != 0} + (cell_a.plane1 != 0) + (cell_a.plane2 != 0);
      for (std::uint32_t side = 0; side < 1u << planes; ++side)
        ASSERT_EQ(a.corner_sets()[cell_a.first_set + side], b.corner_sets()[cell_b.first_set + side]);
    }
  }
}

/// Each texel holds the density of the state, 0 where there is no slot.
void expect_densities(const SmokeVolume& volume, const sim::State& state) {
  const glm::ivec3 size = state.layout.size + 4;
  for (int i = 0; i < size.x * size.y * size.z; ++i) {
    const glm::ivec3 v = glm::ivec3(i % size.x, i / size.x % size.y, i / size.x / size.y) - 2;
    const std::uint32_t slot = volume.slot_at(v >> 3);
    int density = 0;
    if (slot != SmokeVolume::kNoSlot) {
      const glm::ivec3 t = (v & 7) + 1;
      density = volume.texels(slot)[static_cast<std::size_t>(t.x + 10 * (t.y + 10 * t.z))].density;
    }
    ASSERT_EQ(density, state.density(v)) << v.x << ' ' << v.y << ' ' << v.z << " at tick " << state.tick;
  }
}

TEST(SmokeVolume, UpdatedEqualsRebuiltAtAnyTick) {
  const Hut hut;
  sim::World world = hut.world();
  SmokeVolume updated(hut.grid, hut.planes);
  std::mt19937 random(3);
  for (int i = 0; i < 60; ++i) {
    world.advance_to(static_cast<std::uint32_t>(random() % kAllOver));
    updated.update(world);
    expect_densities(updated, world.state());
    SmokeVolume fresh(hut.grid, hut.planes);
    fresh.update(world);
    expect_same(updated, fresh);
  }
}

/// A round room with thin walls and a lid, smoke outside of it, later also inside; then a wall is opened and
/// closed again.
struct Tower {
  static std::vector<Triangle> make_mesh() {
    std::vector<Triangle> mesh;
    for (const float radius : {2.0f, 1.9f})
      for (int i = 0; i < 48; ++i) {
        const auto at = [&](int k) {
          const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(k) / 48;
          return glm::vec3(6 + radius * std::cos(angle), 0, 6 + radius * std::sin(angle));
        };
        add_quad(mesh, at(i), at(i + 1) - at(i), {0, 5.2f, 0});
      }
    add_quad(mesh, {0, 5.2f, 0}, {12, 0, 0}, {0, 0, 12});
    return mesh;
  }
  std::vector<Triangle> mesh = make_mesh();
  BitGrid grid = voxel::voxelize(mesh, {{24, 12, 24}, 0.5f, glm::vec3(0)}).value_or_throw();
  voxel::SurfacePlanes planes = voxel::SurfacePlanes::build(mesh, grid);

  sim::World world() const {
    BitGrid opened = grid;
    sim::apply_edits(opened, sim::edit_box(grid.layout(), {7, 2, 10}, {10, 5, 13}, false));
    return world_of(grid, {sim::ThrowSmoke{0, at(1, 3, 1), at(1, 4, 1), {1500, 20, 150, 30}},
                           sim::ThrowSmoke{50, at(6, 3, 6), at(6, 4, 6), {60, 20, 60, 20}},
                           sim::LevelEdit{80, sim::difference(grid, opened, {0, 0, 0}, grid.size())},
                           sim::LevelEdit{110, sim::difference(opened, grid, {0, 0, 0}, grid.size())}});
  }
};

/// The planes of all boundary cells by place.
std::map<std::tuple<int, int, int>, std::uint32_t> first_planes(const SmokeVolume& volume) {
  std::map<std::tuple<int, int, int>, std::uint32_t> planes;
  for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot)
    for (int i = 0; i < static_cast<int>(shared::kCellsPerBrick); ++i)
      if (const std::uint32_t entry = volume.cells(slot)[static_cast<std::size_t>(i)]; entry != 0) {
        const glm::ivec3 cell = 8 * volume.brick_of(slot) - 1 + glm::ivec3(i % 9, i / 9 % 9, i / 81);
        planes[{cell.x, cell.y, cell.z}] = volume.boundary_cells()[entry - 1].plane0;
      }
  return planes;
}

TEST(SmokeVolume, FollowsPocketsThatFillOpenAndClose) {
  const Tower tower;
  sim::World world = tower.world();
  SmokeVolume updated(tower.grid, tower.planes);
  const auto planes_at = [&](std::uint32_t tick) {
    world.advance_to(tick);
    updated.update(world);
    SmokeVolume fresh(tower.grid, tower.planes);
    fresh.update(world);
    expect_same(updated, fresh);
    return first_planes(fresh);
  };
  // Smoke in the room changes the planes of its walls also where it looks at them from outside.
  const auto sealed = planes_at(40), filled = planes_at(75);
  int moved = 0;
  for (const auto& [cell, plane] : sealed) moved += filled.contains(cell) && filled.at(cell) != plane;
  EXPECT_GT(moved, 10);
  EXPECT_EQ(planes_at(40), sealed);
  std::mt19937 random(21);
  for (int i = 0; i < 40; ++i) planes_at(static_cast<std::uint32_t>(random() % 210));
}

/// A reader that copies what is dirty, and nothing else.
struct Mirror {
  std::vector<std::vector<Texel>> texels;
  std::vector<std::vector<std::uint32_t>> cells;
  std::vector<shared::BoundaryCell> boundary;
  std::vector<glm::uvec2> sets;
  std::vector<std::uint32_t> root, nodes;

  void follow(const SmokeVolume& volume) {
    texels.resize(volume.slot_count());
    cells.resize(volume.slot_count());
    for (const std::uint32_t slot : volume.dirty_slots())
      texels[slot].assign(volume.texels(slot).begin(), volume.texels(slot).end());
    for (const std::uint32_t slot : volume.dirty_cell_slots())
      cells[slot].assign(volume.cells(slot).begin(), volume.cells(slot).end());
    boundary.resize(volume.boundary_cells().size());
    for (const volume::IndexRange& range : volume.dirty_boundary_cells())
      for (std::uint32_t i = range.first; i < range.first + range.count; ++i)
        boundary[i] = volume.boundary_cells()[i];
    sets.resize(volume.corner_sets().size());
    for (const volume::IndexRange& range : volume.dirty_corner_sets())
      for (std::uint32_t i = range.first; i < range.first + range.count; ++i)
        sets[i] = volume.corner_sets()[i];
    const volume::PageTable& pages = volume.pages();
    if (pages.root_changed()) root.assign(pages.root().begin(), pages.root().end());
    nodes.resize(pages.nodes().size());
    for (const std::uint32_t node : pages.changed_nodes())
      for (std::size_t i = node * shared::kPageEntries; i < (node + 1) * shared::kPageEntries; ++i)
        nodes[i] = pages.nodes()[i];
  }
  /// Only the cells in use count.
  void expect_like(const SmokeVolume& volume) const {
    EXPECT_TRUE(std::ranges::equal(root, volume.pages().root()));
    EXPECT_TRUE(std::ranges::equal(nodes, volume.pages().nodes()));
    for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot) {
      ASSERT_TRUE(std::ranges::equal(texels[slot], volume.texels(slot)));
      ASSERT_TRUE(std::ranges::equal(cells[slot], volume.cells(slot)));
      for (const std::uint32_t entry : cells[slot]) {
        if (entry == 0) continue;
        const shared::BoundaryCell& cell = volume.boundary_cells()[entry - 1];
        ASSERT_TRUE(same_planes(boundary[entry - 1], cell));
        ASSERT_EQ(boundary[entry - 1].first_set, cell.first_set);
        const unsigned planes = unsigned{cell.plane0 != 0} + (cell.plane1 != 0) + (cell.plane2 != 0);
        for (std::uint32_t i = cell.first_set; i < cell.first_set + (1u << planes); ++i)
          ASSERT_EQ(sets[i], volume.corner_sets()[i]);
      }
    }
  }
};

TEST(SmokeVolume, HoldsTheDensitiesOfEveryTickAndSaysWhatAnUpdateChanged) {
  const Hut hut;
  sim::World world = hut.world();
  SmokeVolume volume(hut.grid, hut.planes);
  Mirror mirror;
  std::mt19937 random(11);
  for (std::uint32_t i = 0; i < kAllOver + 30; ++i) {
    world.advance_to(i < kAllOver ? i : static_cast<std::uint32_t>(random() % kAllOver));
    volume.update(world);
    expect_densities(volume, world.state());
    const Mirror before = mirror;
    mirror.follow(volume);
    mirror.expect_like(volume);
    // No slot is dirty for nothing.
    for (const std::uint32_t slot : volume.dirty_slots())
      if (slot < before.texels.size()) {
        EXPECT_TRUE(before.texels[slot] != mirror.texels[slot] || before.cells[slot] != mirror.cells[slot]);
      }
  }
}

TEST(SmokeVolume, CostsNothingWhileNothingChanges) {
  const Hut hut;
  sim::World world = hut.world();
  SmokeVolume volume(hut.grid, hut.planes);
  // Everything has grown and holds, every blast has refilled.
  world.advance_to(45);
  volume.update(world);
  const auto quiet = [&] {
    return volume.dirty_slots().empty() && volume.dirty_cell_slots().empty() && !volume.corner_sets_dirty() &&
           volume.dirty_boundary_cells().empty() && !volume.pages().root_changed() &&
           volume.pages().changed_nodes().empty();
  };
  EXPECT_FALSE(quiet());
  const std::uint64_t generation = volume.structure_generation();
  volume.update(world);
  EXPECT_TRUE(quiet());

  // A state that travelled is made of other objects with the same content.
  sim::State copy = world.state();
  for (sim::LiveCloud& live : copy.clouds) live.cloud = std::make_shared<sim::Cloud>(*live.cloud);
  if (copy.edits) copy.edits = std::make_shared<sim::EditBlocks>(*copy.edits);
  volume.update(copy, world.grid());
  EXPECT_TRUE(quiet());
  EXPECT_EQ(volume.structure_generation(), generation);
}

TEST(SmokeVolume, BuildsOnlyWhereACloudComesOrGoes) {
  // Smokes in the corners of a world of 4096 voxels an axis: a table of all its bricks would take 0.5 GB.
  std::vector<Triangle> mesh;
  const BitGrid grid({{4096, 4096, 4096}, 0.25f, glm::vec3(0)});
  sim::World world(grid);
  SmokeVolume volume(grid, [](glm::ivec3) { return std::span<const voxel::Plane>(); });
  for (std::uint32_t i = 0; i < 8; ++i) {
    const sim::Position at = sim::position_from_metres(glm::dvec3(i & 1, i >> 1 & 1, i >> 2) * 1000.0 + 10.0);
    world.append(sim::ThrowSmoke{10 * i, at, at, {300, 5, 200, 50}}).value_or_throw();
  }
  std::size_t alone = 0;
  for (std::uint32_t i = 0; i < 8; ++i) {
    world.advance_to(10 * i + 9);
    volume.update(world);
    if (i == 0) alone = volume.dirty_slots().size();
    // The corners lie alike in their bricks up to the rounding of the landing.
    EXPECT_LE(volume.dirty_slots().size(), 2 * alone);
    EXPECT_EQ(volume.dirty_cell_slots().size(), volume.dirty_slots().size());
  }
  EXPECT_LT(volume.bytes(), 8u << 20);
  // They are gone in the order in which they came.
  world.advance_to(1000);
  volume.update(world);
  EXPECT_EQ(volume.slot_count(), 0u);
  EXPECT_EQ(volume.layout().bricks.window_size, glm::ivec3(0));
  EXPECT_TRUE(volume.boundary_cells().empty());
}

TEST(SmokeVolume, TakesNewPlanesWhereItIsToldTo) {
  const Hut hut;
  std::vector<Triangle> moved = hut.mesh;
  for (Triangle& triangle : moved)
    for (glm::vec3* corner : {&triangle.a, &triangle.b, &triangle.c})
      if (corner->x == 6.2f) corner->x = 6.35f;
  const voxel::SurfacePlanes other = voxel::SurfacePlanes::build(moved, hut.grid);
  sim::World world = hut.world();
  world.advance_to(66);
  const voxel::SurfacePlanes* planes = &hut.planes;
  SmokeVolume updated(hut.grid, [&](glm::ivec3 cell) { return planes->at(cell); });
  updated.update(world);
  planes = &other;
  // The inner wall and half a voxel around it.
  updated.planes_changed({11, -1, 3}, {13, 8, 15});
  updated.update(world);
  SmokeVolume fresh(hut.grid, other);
  fresh.update(world);
  expect_same(updated, fresh);
  SmokeVolume before(hut.grid, hut.planes);
  before.update(world);
  EXPECT_NE(sample_density(before, {12.5f, 4, 9}), sample_density(fresh, {12.5f, 4, 9}));
}

TEST(SmokeVolume, IsTrilinearWhereNothingIsSolid) {
  const BitGrid grid({{33, 17, 5}, 0.25f, glm::vec3(1)});
  sim::World world(grid);
  const sim::Position at = sim::position_from_metres({5, 3, 1.6});
  world.append(sim::ThrowSmoke{0, at, at, {600, 30}}).value_or_throw();
  world.advance_to(12);
  SmokeVolume volume(grid, [](glm::ivec3) { return std::span<const voxel::Plane>(); });
  volume.update(world);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> share(-0.1f, 1.1f);
  int smoky = 0;
  for (int i = 0; i < 20000; ++i) {
    const glm::vec3 p = glm::vec3(share(random), share(random), share(random)) * glm::vec3(grid.size());
    const glm::dvec3 q = glm::dvec3(p) - 0.5, low = glm::floor(q), f = q - low;
    double expected = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::ivec3 o(corner & 1, corner >> 1 & 1, corner >> 2);
      const glm::dvec3 w = glm::mix(1.0 - f, f, glm::dvec3(o));
      expected += w.x * w.y * w.z * world.state().density(glm::ivec3(low) + o) / 255.0;
    }
    ASSERT_NEAR(sample_density(volume, p), expected, 1e-5);
    smoky += expected > 0;
    if (expected > 0) {
      EXPECT_TRUE(glm::all(glm::greaterThanEqual(p, volume.layout().bounds_min)));
      EXPECT_TRUE(glm::all(glm::lessThanEqual(p, volume.layout().bounds_max)));
    }
  }
  EXPECT_GT(smoky, 1000);
}

TEST(SmokeVolume, BricksAgreeOnTheirCommonFaces) {
  const Hut hut;
  sim::World world = hut.world();
  world.advance_to(90);
  SmokeVolume volume(hut.grid, hut.planes);
  volume.update(world);
  std::mt19937 random(9);
  std::uniform_real_distribution<float> share(0, 1);
  int smoky = 0;
  for (int i = 0; i < 20000; ++i) {
    glm::vec3 p = glm::vec3(share(random), share(random), share(random)) * glm::vec3(hut.grid.size());
    const int axis = i % 3;
    p[axis] = 8 * std::floor(p[axis] / 8);
    glm::vec3 before = p;
    before[axis] = std::nextafter(p[axis], -1.0f);
    // A point and the next float lie in different bricks but in the same cell.
    const float a = sample_density(volume, p), b = sample_density(volume, before);
    ASSERT_NEAR(a, b, 1e-4) << p.x << ", " << p.y << ", " << p.z;
    smoky += a > 0;
  }
  EXPECT_GT(smoky, 500);
}

TEST(SmokeVolume, IsEmptyWithoutSmoke) {
  const Hut hut;
  sim::World world(hut.grid);
  SmokeVolume volume(hut.grid, hut.planes);
  volume.update(world);
  EXPECT_EQ(volume.slot_count(), 0u);
  EXPECT_EQ(volume.layout().bricks.window_size, glm::ivec3(0));
  EXPECT_EQ(sample_density(volume, {3, 3, 3}), 0);
}

}  // namespace
}  // namespace brume::smoke
