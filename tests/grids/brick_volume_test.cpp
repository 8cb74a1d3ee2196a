#include "grids/brick_volume.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>
#include <random>

namespace brume::grids {
namespace {

/// A grid of random bricks around the origin; half of the voxels are 0.
Grid random_grid(std::uint32_t seed) {
  std::mt19937 random(seed);
  Grid grid;
  grid.name = "density";
  grid.world_from_index =
      glm::translate(glm::dmat4(1), glm::dvec3(1, 2, 3)) * glm::scale(glm::dmat4(1), glm::dvec3(0.5));
  for (int z = -2; z < 2; ++z)
    for (int y = -1; y < 2; ++y)
      for (int x = -2; x < 1; ++x) {
        if (random() % 3 == 0) continue;
        Brick& brick = grid.bricks.emplace_back();
        brick.origin = glm::ivec3(x, y, z) * 8;
        for (std::size_t voxel = 0; voxel < kBrickVoxels; ++voxel) {
          const float value = random() % 2 == 0 ? 0 : static_cast<float>(random() % 1000) / 500;
          if (value > 0) brick.active[voxel / 64] |= std::uint64_t{1} << (voxel % 64);
          const auto* const bytes = reinterpret_cast<const std::byte*>(&value);
          grid.values.insert(grid.values.end(), bytes, bytes + sizeof value);
        }
      }
  return grid;
}

float value_at(const Grid& grid, glm::ivec3 at) {
  const auto brick = find_brick(grid, (at >> 3) * 8);
  if (!brick) return 0;
  const glm::ivec3 in = at & 7;
  float value = 0;
  std::memcpy(&value, grid.values_of(*brick).data() + 4 * (in.x + 8 * (in.y + 8 * in.z)), sizeof value);
  return value;
}

/// What filtering of the bricks gives at a point of voxel space, as the device does.
float filtered(const volume::SparseVolume& volume, glm::vec3 p) {
  const glm::ivec3 brick = glm::ivec3(glm::floor(p / 8.0f));
  const std::uint32_t slot = volume.slot_at(brick);
  if (slot == volume::SparseVolume::kNoSlot) return 0;
  const auto texels = volume.texels<std::uint16_t>(volume::ChannelId{0}, slot);
  const glm::vec3 q = p - glm::vec3(brick * 8) + 0.5f;  // texel centres at whole numbers, the apron's at 0
  const glm::ivec3 first = glm::ivec3(glm::floor(q));
  const glm::vec3 weight = q - glm::vec3(first);
  float sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 side(corner & 1, corner >> 1 & 1, corner >> 2), texel = first + side;
    const glm::vec3 w = glm::mix(1.0f - weight, weight, glm::vec3(side));
    sum += w.x * w.y * w.z *
           glm::unpackHalf1x16(texels[static_cast<std::size_t>(texel.x + 10 * (texel.y + 10 * texel.z))]);
  }
  return sum;
}

TEST(BrickVolume, FiltersAsTheGridEverywhere) {
  const Grid grid = random_grid(3);
  const BrickVolume bricks = make_brick_volume(grid).value_or_throw();
  EXPECT_EQ(bricks.level, 0);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> draw(-26, 20);
  for (int i = 0; i < 20000; ++i) {
    const glm::vec3 p(draw(random), draw(random), draw(random));
    // Index i has its centre at voxel space i + 1/2.
    const glm::vec3 index = p - 0.5f;
    const glm::ivec3 first = glm::ivec3(glm::floor(index));
    const glm::vec3 weight = index - glm::vec3(first);
    float expected = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::ivec3 side(corner & 1, corner >> 1 & 1, corner >> 2);
      const glm::vec3 w = glm::mix(1.0f - weight, weight, glm::vec3(side));
      expected += w.x * w.y * w.z * value_at(grid, first + side);
    }
    EXPECT_NEAR(filtered(*bricks.volume, p), expected, 2.0f / 1024) << p.x << ' ' << p.y << ' ' << p.z;
    const shared::VolumeLayout& layout = bricks.volume->layout();
    if (expected > 0) {
      EXPECT_TRUE(Box<float>(layout.bounds_min, layout.bounds_max).contains(p));
    }
  }
  const glm::dvec4 corner = bricks.world_from_voxel * glm::dvec4(0.5, 0.5, 0.5, 1);
  EXPECT_EQ(glm::dvec3(corner), glm::dvec3(grid.world_from_index * glm::dvec4(0, 0, 0, 1)));
}

TEST(BrickVolume, HalvesUntilItFitsAndKeepsTheSum) {
  const Grid grid = random_grid(4);
  const BrickVolume fine = make_brick_volume(grid).value_or_throw();
  const BrickVolume coarse = make_brick_volume(grid, {fine.volume->slot_count() / 3}).value_or_throw();
  EXPECT_GE(coarse.level, 1);
  EXPECT_LE(coarse.volume->slot_count(), fine.volume->slot_count() / 3);
  EXPECT_NEAR(coarse.sum * std::exp2(3 * coarse.level), fine.sum, 1e-4 * fine.sum) << "the mass remains";
  EXPECT_GT(coarse.rms_error, 0);
  // The same place in the world: a value moves by half a coarse voxel at most.
  const glm::dvec3 a(fine.world_from_voxel * glm::dvec4(fine.mean, 1));
  const glm::dvec3 b(coarse.world_from_voxel * glm::dvec4(coarse.mean, 1));
  EXPECT_LT(glm::length(a - b), 0.5 * 0.5 * std::exp2(coarse.level));
}

// Densities of 1e-8 and 1e20 are far outside of half floats.
TEST(BrickVolume, ValuesThatHalfFloatsLackHaveAUnit) {
  for (const float factor : {1e-8f, 1e-3f, 1.0f, 300.0f, 1e6f, 1e20f}) {
    Grid grid = random_grid(3);
    for (std::size_t i = 0; i < grid.values.size(); i += 4) {
      float value = 0;
      std::memcpy(&value, &grid.values[i], sizeof value);
      value *= factor;
      std::memcpy(&grid.values[i], &value, sizeof value);
    }
    const BrickVolume bricks = make_brick_volume(grid).value_or_throw();
    EXPECT_EQ(bricks.unit == 1, factor > 0.01f && factor < 500) << factor;
    for (int x = -16; x < 8; ++x) {
      const float expected = value_at(grid, {x, 3, 5});
      EXPECT_NEAR(filtered(*bricks.volume, glm::vec3(x, 3, 5) + 0.5f) * bricks.unit, expected, factor / 500)
          << factor;
    }
  }
}

TEST(BrickVolume, ALevelSetIsSolidInsideAndEmptyOutside) {
  Grid grid;
  grid.grid_class = GridClass::level_set;
  const float outside = 1.5f, inside = -1.5f;
  std::memcpy(grid.background.data(), &outside, sizeof outside);
  grid.world_from_index = glm::scale(glm::dmat4(1), glm::dvec3(0.5));
  Brick& brick = grid.bricks.emplace_back();
  for (std::size_t voxel = 0; voxel < kBrickVoxels; ++voxel) {
    const float distance = 0.5f * (static_cast<float>(voxel % 8) - 3);  // [world], the surface at x = 3
    brick.active[voxel / 64] |= std::uint64_t{1} << (voxel % 64);
    const auto* const bytes = reinterpret_cast<const std::byte*>(&distance);
    grid.values.insert(grid.values.end(), bytes, bytes + 4);
  }
  Tile tile{{-8, 0, 0}, 8, false, {}};
  std::memcpy(tile.value.data(), &inside, sizeof inside);
  grid.tiles = {tile};
  const BrickVolume bricks = make_brick_volume(grid).value_or_throw();
  for (int x = -7; x < 8; ++x)
    EXPECT_NEAR(filtered(*bricks.volume, glm::vec3(x, 4, 4) + 0.5f),
                std::clamp((3.0f - static_cast<float>(x)) / 3, 0.0f, 1.0f), 1e-3f)
        << x;
}

TEST(BrickVolume, RefusesMasksAndHugeTiles) {
  Grid grid;
  grid.type = ValueType::mask;
  EXPECT_EQ(make_brick_volume(grid).failure().code, ErrorCode::bad_input);
  grid.type = ValueType::float32;
  Tile tile{glm::ivec3(0), 4096, true, {}};
  const float one = 1;
  std::memcpy(tile.value.data(), &one, sizeof one);
  grid.tiles = {tile};
  EXPECT_EQ(make_brick_volume(grid).failure().code, ErrorCode::resource_limit);
  grid.tiles.clear();
  const BrickVolume nothing = make_brick_volume(grid).value_or_throw();
  EXPECT_EQ(nothing.volume->slot_count(), 0u);
}

}  // namespace
}  // namespace brume::grids
