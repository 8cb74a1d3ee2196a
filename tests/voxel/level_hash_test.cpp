#include "voxel/level_hash.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <vector>

#include "tests/voxel/random.hpp"
#include "voxel/voxelize.hpp"

namespace brume::voxel {
namespace {

const GridLayout kHashedLayout{{19, 11, 23}, 0.5f, {-3, 1, 2}};

glm::ivec3 any_voxel(Random& random) {
  glm::ivec3 v;
  for (int axis = 0; axis < 3; ++axis)
    v[axis] = static_cast<int>(random() % static_cast<unsigned>(kHashedLayout.size[axis]));
  return v;
}

/// A level with walls, glass and grilles.
struct RoleLevel {
  BitGrid smoke{kHashedLayout};
  RoleGrids roles{BitGrid(kHashedLayout), BitGrid(kHashedLayout)};
  std::uint64_t hash() const { return level_hash({smoke, roles}, {}); }
  void set(glm::ivec3 v, Role role) {
    smoke.set(v, stops_smoke(role));
    roles.sight->set(v, stops_sight(role));
    roles.bodies->set(v, stops_bodies(role));
  }
};

RoleLevel any_level(unsigned seed) {
  RoleLevel level;
  Random random(seed);
  for (int i = 0; i < 400; ++i) level.set(any_voxel(random), static_cast<Role>(random() % 4));
  return level;
}

TEST(LevelHash, DependsOnWhatEachVoxelStops) {
  RoleLevel level = any_level(1);
  Random random(2);
  std::set<std::uint64_t> hashes{level.hash()};
  for (int i = 0; i < 300; ++i) {
    const glm::ivec3 v = any_voxel(random);
    const Role before = Solids(level.smoke, level.roles).role(v);
    for (int role = 0; role < 4; ++role) {
      if (static_cast<Role>(role) == before) continue;
      level.set(v, static_cast<Role>(role));
      EXPECT_NE(level.hash(), *hashes.begin()) << v.x << "," << v.y << "," << v.z << " role " << role;
    }
    level.set(v, before);
    hashes.insert(level.hash());
  }
  EXPECT_EQ(hashes.size(), 1u) << "the same voxels again have the same hash";
}

TEST(LevelHash, IsOfTheContentAndNotOfItsStorage) {
  // Written in another order, with bricks that have become empty.
  const RoleLevel level = any_level(3);
  RoleLevel other;
  for (int z = kHashedLayout.size.z - 1; z >= 0; --z)
    for (int y = 0; y < kHashedLayout.size.y; ++y)
      for (int x = kHashedLayout.size.x - 1; x >= 0; --x) {
        other.set({x, y, z}, Role::wall);
        other.set({x, y, z}, Solids(level.smoke, level.roles).role({x, y, z}));
      }
  EXPECT_EQ(other.hash(), level.hash());

  // Roles that equal the walls are none.
  BitGrid walls(kHashedLayout);
  Random random(4);
  for (int i = 0; i < 100; ++i) walls.set(any_voxel(random), true);
  EXPECT_EQ(level_hash({walls, RoleGrids{walls, walls}}, {}), level_hash(walls, {}));
}

TEST(LevelHash, DependsOnTheLayout) {
  std::set<std::uint64_t> hashes{level_hash(BitGrid(kHashedLayout), {})};
  for (int axis = 0; axis < 3; ++axis) {
    GridLayout larger = kHashedLayout, moved = kHashedLayout;
    ++larger.size[axis];
    moved.origin_world[axis] += 0.5f;
    hashes.insert(level_hash(BitGrid(larger), {}));
    hashes.insert(level_hash(BitGrid(moved), {}));
  }
  GridLayout finer = kHashedLayout;
  finer.voxel_size = 0.25f;
  hashes.insert(level_hash(BitGrid(finer), {}));
  EXPECT_EQ(hashes.size(), 8u);
  EXPECT_EQ(hashes.count(0), 0u);
}

/// The hash of a wall at a height in the middle of its voxels.
std::uint64_t hash_of_wall(float x) {
  const std::array<Triangle, 2> wall{Triangle{{x, 1.5f, 3}, {x, 1.5f, 9}, {x, 5.5f, 9}},
                                     Triangle{{x, 1.5f, 3}, {x, 5.5f, 9}, {x, 5.5f, 3}}};
  const BitGrid grid = voxelize(wall, kHashedLayout).value_or_throw();
  return level_hash(grid, SurfacePlanes::build(wall, grid));
}

// Smoke ends at the surface: a wall that moves within its voxels is another level.
TEST(LevelHash, DependsOnTheSurfaces) {
  const std::uint64_t hash = hash_of_wall(1.2f);
  EXPECT_EQ(hash, hash_of_wall(1.2f));
  EXPECT_NE(hash, hash_of_wall(1.25f));
  EXPECT_NE(hash_of_wall(1.25f), hash_of_wall(1.3f));
}

}  // namespace
}  // namespace brume::voxel
