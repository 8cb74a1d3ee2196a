// Levels and matches for the tests of src/wire.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <vector>

#include "sim/level_edit.hpp"
#include "sim/state.hpp"
#include "sim/world.hpp"
#include "voxel/bit_grid.hpp"

namespace brume::wire {

inline void fill_box(voxel::BitGrid& grid, glm::ivec3 low, glm::ivec3 high, bool solid) {
  const sim::EditBlocks edits = sim::edit_box(grid.layout(), low, high, solid);
  sim::apply_edits(grid, edits);
}

/// Voxels of half a metre; the ground is solid.
inline voxel::BitGrid yard(glm::ivec3 size = {96, 32, 96}) {
  voxel::BitGrid grid({size, 0.5f, glm::vec3(-24, -0.5f, -24)});
  fill_box(grid, {0, 0, 0}, {size.x, 1, size.z}, true);
  return grid;
}

/// Rooms of 12 x 6 x 10 voxels with doors of two voxels, furniture in each.
inline voxel::BitGrid rooms(unsigned seed, glm::ivec3 size = {96, 8, 96}) {
  voxel::BitGrid grid = yard(size);
  std::mt19937 random(seed);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  fill_box(grid, {0, 7, 0}, {size.x, 8, size.z}, true);
  for (int x = 0; x < size.x; x += 13) fill_box(grid, {x, 0, 0}, {x + 1, 7, size.z}, true);
  for (int z = 0; z < size.z; z += 11) fill_box(grid, {0, 0, z}, {size.x, 7, z + 1}, true);
  for (int x = 0; x < size.x; x += 13)
    for (int z = 0; z < size.z; z += 11) {
      const int door_z = z + 3 + below(5), door_x = x + 3 + below(7);
      fill_box(grid, {x, 1, door_z}, {x + 1, 5, door_z + 2}, false);
      fill_box(grid, {door_x, 1, z}, {door_x + 2, 5, z + 1}, false);
      for (int thing = 0; thing < 6; ++thing) {
        const glm::ivec3 low(x + 1 + below(11), below(4) == 0 ? 4 : 1, z + 1 + below(9));
        fill_box(grid, low, low + glm::ivec3(1 + below(3), 1 + below(3), 1 + below(3)), true);
      }
    }
  return grid;
}

/// Corridors of 4 x 5 voxels along z.
inline voxel::BitGrid corridors(glm::ivec3 size = {64, 8, 480}) {
  voxel::BitGrid grid = yard(size);
  fill_box(grid, {0, 6, 0}, {size.x, 7, size.z}, true);
  for (int x = 0; x < size.x; x += 5) fill_box(grid, {x, 0, 0}, {x + 1, 6, size.z}, true);
  return grid;
}

/// The Position of a voxel's centre in these levels.
inline sim::Position centre_of(const voxel::BitGrid& grid, glm::ivec3 voxel) {
  return sim::VoxelRuler(grid.layout()).centre(voxel);
}

/// A random free voxel.
inline glm::ivec3 free_voxel(const voxel::BitGrid& grid, std::mt19937& random) {
  for (;;) {
    glm::ivec3 v;
    for (int axis = 0; axis < 3; ++axis)
      v[axis] = static_cast<int>(random() % static_cast<unsigned>(grid.size()[axis]));
    if (grid.free(v)) return v;
  }
}

/// The mask key of busy matches, whose shots use masks.
constexpr sim::WorldSettings kBusySettings{.masks = {5, 0x0123456789abcdefull}};

/// A busy match of `ticks` ticks: smokes, shots, blasts, bodies, and doors that open and close.
inline std::vector<sim::Event> busy_match(const voxel::BitGrid& level, unsigned seed, std::uint32_t ticks,
                                          std::uint32_t voxels) {
  std::mt19937 random(seed);
  const auto tick = [&] { return static_cast<std::uint32_t>(random() % ticks); };
  const auto place = [&] { return centre_of(level, free_voxel(level, random)); };
  std::vector<sim::Event> events;
  events.reserve(300);
  for (int i = 0; i < 8; ++i)
    events.push_back(sim::ThrowSmoke{tick(), place(), place(), {voxels, 64, ticks / 4, 96}});
  for (int i = 0; i < 200; ++i) {
    sim::Shot shot{tick(), place(), place(), 205, {}};
    if (shot.origin == shot.toward) ++shot.toward.x;
    shot.shape = static_cast<sim::HoleShape>(i % 3);
    if (shot.shape == sim::HoleShape::mask)
      shot.mask = static_cast<std::uint32_t>(i) % kBusySettings.masks.count;
    if (shot.shape != sim::HoleShape::cylinder)
      shot.roll = static_cast<std::uint32_t>(i) * 977 % sim::kFullTurn;
    events.push_back(shot);
  }
  for (int i = 0; i < 5; ++i) events.push_back(sim::Blast{tick(), place()});
  for (int i = 0; i < 60; ++i)
    events.push_back(sim::MoveBody{tick(), static_cast<std::uint32_t>(random() % 3), place()});
  for (int door = 0; door < 2; ++door) {
    const glm::ivec3 low = free_voxel(level, random) - glm::ivec3(3);
    const std::uint32_t opens = tick();
    events.push_back(sim::LevelEdit{opens, sim::edit_box(level.layout(), low, low + 6, false)});
    events.push_back(sim::LevelEdit{(opens + ticks) / 2, sim::edit_box(level.layout(), low, low + 6, true)});
  }
  return events;
}

inline sim::World world_of(const voxel::BitGrid& level, const std::vector<sim::Event>& events) {
  sim::World world(level, kBusySettings);
  for (const sim::Event& event : events) world.append(event).value_or_throw();
  return world;
}

/// The smoke of one throw in a yard of at least 24 x 12 x 24 voxels, and more.
inline sim::World one_smoke(const voxel::BitGrid& level, std::vector<sim::Event> more = {}) {
  more.insert(more.begin(),
              sim::ThrowSmoke{0, centre_of(level, {12, 3, 4}), centre_of(level, {12, 1, 12}), {300}});
  return world_of(level, more);
}

/// Whether hashes and the densities of all voxels are equal.
inline void expect_same(const sim::State& got, const sim::State& expected) {
  ASSERT_EQ(got.hash(), expected.hash()) << "tick " << expected.tick;
  ASSERT_EQ(got.clouds.size(), expected.clouds.size());
  for (const sim::State* state : {&got, &expected})
    for (const sim::LiveCloud& live : state->clouds)
      live.cloud->voxels().for_each([&](glm::ivec3 voxel, std::uint32_t) {
        ASSERT_EQ(got.density(voxel), expected.density(voxel)) << voxel.x << "," << voxel.y << "," << voxel.z;
      });
}

}  // namespace brume::wire
