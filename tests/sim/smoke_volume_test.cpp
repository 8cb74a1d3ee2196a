#include "sim/smoke_volume.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "sim/pack_plane.hpp"
#include "voxel/voxelize.hpp"

namespace brume::sim {
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

struct Hut {
  std::vector<Triangle> mesh = make_hut();
  BitGrid grid = voxel::voxelize(mesh, {{29, 13, 25}, 0.5f, glm::vec3(0)}).value_or_throw();
  voxel::SurfacePlanes planes = voxel::SurfacePlanes::build(mesh, grid);

  World world() const {
    World result(grid);
    const auto at = [](double x, double y, double z) { return position_from_metres({x, y, z}); };
    result.append(ThrowSmoke{0, at(4, 1.5, 4), at(4, 1.4, 8), {900, 64}}).value_or_throw();
    result.append(ThrowSmoke{50, at(8, 1.5, 9), at(8, 1.4, 3), {500, 40}}).value_or_throw();
    result.append(ThrowSmoke{120, at(12, 2, 12), at(13, 1, 11), {700, 40}}).value_or_throw();
    return result;
  }
};

void expect_same(const SmokeVolume& a, const SmokeVolume& b) {
  ASSERT_EQ(a.slot_count(), b.slot_count());
  EXPECT_EQ(a.frame().window_origin, b.frame().window_origin);
  EXPECT_EQ(a.frame().window_size, b.frame().window_size);
  EXPECT_EQ(a.frame().bounds_min, b.frame().bounds_min);
  EXPECT_EQ(a.frame().bounds_max, b.frame().bounds_max);
  EXPECT_TRUE(std::ranges::equal(a.page_table(), b.page_table()));
  EXPECT_TRUE(std::ranges::equal(a.corner_sets(), b.corner_sets()));
  const auto same_cell = [](const shared::BoundaryCell& x, const shared::BoundaryCell& y) {
    return x.plane0 == y.plane0 && x.plane1 == y.plane1 && x.plane2 == y.plane2 && x.first_set == y.first_set;
  };
  EXPECT_TRUE(std::ranges::equal(a.boundary_cells(), b.boundary_cells(), same_cell));
  for (std::uint32_t slot = 0; slot < a.slot_count(); ++slot) {
    ASSERT_TRUE(std::ranges::equal(a.texels(slot), b.texels(slot))) << slot;
    ASSERT_TRUE(std::ranges::equal(a.cells(slot), b.cells(slot))) << slot;
  }
}

TEST(SmokeVolume, UpdatedEqualsMadeAnewAtAnyTick) {
  const Hut hut;
  World world = hut.world();
  SmokeVolume kept(hut.grid, hut.planes);
  std::mt19937 random(3);
  for (int i = 0; i < 40; ++i) {
    world.advance_to(static_cast<std::uint32_t>(random() % 260));
    kept.update(world);
    SmokeVolume fresh(hut.grid, hut.planes);
    fresh.update(world);
    expect_same(kept, fresh);
  }
}

TEST(SmokeVolume, SaysWhatAnUpdateChanged) {
  const Hut hut;
  World world = hut.world();
  SmokeVolume volume(hut.grid, hut.planes);
  std::uint64_t generation = 0;
  std::size_t structures = 0, last_clouds = 0;
  std::vector<std::vector<Texel>> texels;
  std::vector<glm::uvec2> sets;
  for (std::uint32_t tick = 0; tick < 220; ++tick) {
    world.advance_to(tick);
    volume.update(world);
    const bool rebuilt = volume.structure_generation() != generation;
    EXPECT_EQ(rebuilt && tick > 0, world.clouds().size() != last_clouds);
    if (rebuilt) texels.assign(volume.slot_count(), {});
    structures += rebuilt;
    generation = volume.structure_generation();
    last_clouds = world.clouds().size();
    const std::set<std::uint32_t> dirty(volume.dirty_slots().begin(), volume.dirty_slots().end());
    for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot) {
      const bool changed = !std::ranges::equal(texels[slot], volume.texels(slot));
      EXPECT_EQ(dirty.contains(slot), changed);
      texels[slot].assign(volume.texels(slot).begin(), volume.texels(slot).end());
    }
    EXPECT_EQ(volume.corner_sets_dirty(), rebuilt || !std::ranges::equal(sets, volume.corner_sets()));
    sets.assign(volume.corner_sets().begin(), volume.corner_sets().end());
  }
  EXPECT_EQ(structures, 3u);
  // A smoke that has grown costs nothing more.
  EXPECT_TRUE(volume.dirty_slots().empty());
  EXPECT_FALSE(volume.corner_sets_dirty());
}

TEST(SmokeVolume, IsTrilinearWhereNothingIsSolid) {
  const BitGrid grid({{33, 17, 5}, 0.25f, glm::vec3(1)});
  World world(grid);
  const Position at = position_from_metres({5, 3, 1.6});
  world.append(ThrowSmoke{0, at, at, {600, 30}}).value_or_throw();
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
      expected += w.x * w.y * w.z * world.density(glm::ivec3(low) + o) / 255.0;
    }
    ASSERT_NEAR(sample_density(volume, p), expected, 1e-5);
    smoky += expected > 0;
    if (expected > 0) {
      EXPECT_TRUE(glm::all(glm::greaterThanEqual(p, volume.frame().bounds_min)));
      EXPECT_TRUE(glm::all(glm::lessThanEqual(p, volume.frame().bounds_max)));
    }
  }
  EXPECT_GT(smoky, 1000);
}

TEST(SmokeVolume, BricksAgreeOnTheirCommonFaces) {
  const Hut hut;
  World world = hut.world();
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
  World world(hut.grid);
  SmokeVolume volume(hut.grid, hut.planes);
  volume.update(world);
  EXPECT_EQ(volume.slot_count(), 0u);
  EXPECT_EQ(volume.frame().window_size, glm::ivec3(0));
  EXPECT_EQ(sample_density(volume, {3, 3, 3}), 0);
}

TEST(PackPlane, KeepsNormalAndOffset) {
  std::mt19937 random(4);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> offset(-1, 1);
  // Half a step of the map is 1/1022 per axis. On a face of the octahedron a move of (dx, dy) is one of at
  // most sqrt(3) its length, seen from a distance of at least 1 / sqrt(3): three times the angle.
  const double bound = 3 * std::sqrt(2.0) / 1022;
  for (int i = 0; i < 20000; ++i) {
    voxel::Plane plane{glm::normalize(glm::vec3(normal(random), normal(random), normal(random))),
                       offset(random)};
    if (i < 6) plane.normal = glm::vec3(i % 3 == 0, i % 3 == 1, i % 3 == 2) * (i < 3 ? 1.0f : -1.0f);
    const std::uint32_t packed = pack_plane(plane);
    ASSERT_NE(packed, 0u);
    const glm::dvec3 n(shared::plane_normal(packed));
    EXPECT_NEAR(glm::length(n), 1, 1e-6);
    EXPECT_LE(std::atan2(glm::length(glm::cross(n, glm::dvec3(plane.normal))),
                         glm::dot(n, glm::dvec3(plane.normal))),
              i < 6 ? 1e-6 : bound);
    EXPECT_NEAR(shared::plane_offset(packed), plane.offset, 1.0 / 4094 + 1e-6);
  }
  EXPECT_NE(pack_plane({glm::vec3(0, 0, -1), -1}), 0u);
  EXPECT_NEAR(shared::plane_normal(pack_plane({glm::vec3(0, 0, -1), -1})).z, -1, 1e-6);
}

}  // namespace
}  // namespace brume::sim
