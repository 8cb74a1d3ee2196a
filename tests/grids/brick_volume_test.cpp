#include "grids/brick_volume.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>
#include <limits>
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

template <typename Change>
void change_values(Grid& grid, Change change) {
  for (std::size_t i = 0; i < grid.values.size(); i += sizeof(float)) {
    float value = 0;
    std::memcpy(&value, &grid.values[i], sizeof value);
    value = change(value);
    std::memcpy(&grid.values[i], &value, sizeof value);
  }
}

/// What filtering gives at a point among values at whole numbers.
template <typename At>
float trilinear(glm::vec3 p, At at) {
  const glm::ivec3 first = glm::ivec3(glm::floor(p));
  const glm::vec3 weight = p - glm::vec3(first);
  float sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 side(corner & 1, corner >> 1 & 1, corner >> 2);
    const glm::vec3 w = glm::mix(1.0f - weight, weight, glm::vec3(side));
    sum += w.x * w.y * w.z * at(first + side);
  }
  return sum;
}

/// What filtering gives at a point of a brick [voxels from its low corner], as the device does.
float filtered_in(const volume::SparseVolume& volume, std::uint32_t slot, glm::vec3 p) {
  const auto texels = volume.texels<std::uint16_t>(volume::ChannelId{0}, slot);
  // Texel centres are at whole numbers, the apron's at 0.
  return trilinear(p + 0.5f, [&](glm::ivec3 texel) {
    return glm::unpackHalf1x16(texels[static_cast<std::size_t>(texel.x + 10 * (texel.y + 10 * texel.z))]);
  });
}

/// The same at a point of voxel space.
float filtered(const volume::SparseVolume& volume, glm::vec3 p) {
  const glm::ivec3 brick = glm::ivec3(glm::floor(p / 8.0f));
  if (const auto texel = volume.uniform_at(brick)) return glm::unpackHalf1x16(*texel);
  const std::uint32_t slot = volume.slot_at(brick);
  return slot == volume::SparseVolume::kNoSlot ? 0 : filtered_in(volume, slot, p - glm::vec3(brick * 8));
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
    const float expected = trilinear(p - 0.5f, [&](glm::ivec3 voxel) { return value_at(grid, voxel); });
    EXPECT_NEAR(filtered(*bricks.volume, p), expected, 2.0f / 1024) << p.x << ' ' << p.y << ' ' << p.z;
    const shared::VolumeLayout& layout = bricks.volume->layout();
    if (expected > 0) {
      EXPECT_TRUE((Box<float>{layout.bounds_min, layout.bounds_max}).contains(p));
    }
  }
  const glm::dvec4 corner = bricks.world_from_voxel * glm::dvec4(0.5, 0.5, 0.5, 1);
  EXPECT_EQ(glm::dvec3(corner), glm::dvec3(grid.world_from_index * glm::dvec4(0, 0, 0, 1)));
}

// With a shift the field is that of all values, and of the background wherever no voxel is, up to the bounds.
TEST(BrickVolume, AShiftKeepsValuesBelowZero) {
  constexpr ValueShift kShift{-1.5f, -1.6f};
  for (const float background : {0.0f, -0.5f}) {
    Grid grid = random_grid(8);
    // From -4 to 4.
    change_values(grid, [&](float value) { return value > 0 ? 4 * (value - 1) : background; });
    std::memcpy(grid.background.data(), &background, sizeof background);
    const BrickVolume volume = make_brick_volume(grid, {.shift = kShift}).value_or_throw();
    EXPECT_EQ(volume.offset, kShift.offset);
    EXPECT_NEAR(volume.low, kShift.least, 1e-6f);
    const auto at = [&](glm::ivec3 voxel) {
      const bool has_brick = find_brick(grid, (voxel >> 3) * 8).has_value();
      return std::max(has_brick ? value_at(grid, voxel) : background, kShift.least);
    };
    const shared::VolumeLayout& layout = volume.volume->layout();
    std::mt19937 random(9);
    for (int i = 0; i < 4000; ++i) {
      const glm::vec3 part(random() % 1000, random() % 1000, random() % 1000);
      const glm::vec3 p = glm::mix(layout.bounds_min, layout.bounds_max, (part + 0.5f) / 1000.0f);
      const float expected = trilinear(p - 0.5f, at);
      // Halves below 8 are off by 2^-9 at most.
      EXPECT_NEAR(volume.unit * filtered(*volume.volume, p) + volume.offset, expected, 1.0f / 512 + 1e-5f)
          << i;
    }
  }
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
    change_values(grid, [&](float value) { return value * factor; });
    const BrickVolume bricks = make_brick_volume(grid).value_or_throw();
    EXPECT_EQ(bricks.unit == 1, factor > 0.01f && factor < 500) << factor;
    for (int x = -16; x < 8; ++x) {
      const float expected = value_at(grid, {x, 3, 5});
      EXPECT_NEAR(filtered(*bricks.volume, glm::vec3(x, 3, 5) + 0.5f) * bricks.unit, expected, factor / 500)
          << factor;
    }
  }
}

// One infinite or absurd value leaves the others as they are.
TEST(BrickVolume, WhatIsNoNumberIsTheLargestOrNothing) {
  const Grid good = random_grid(5);
  const BrickVolume expected = make_brick_volume(good).value_or_throw();
  EXPECT_EQ(expected.odd, 0u);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const float odd : {kInfinity, 3e38f, std::nanf(""), -kInfinity, 1e5f * expected.high}) {
    Grid grid = good;
    std::memcpy(&grid.values[4 * 100], &odd, sizeof odd);
    const BrickVolume volume = make_brick_volume(grid).value_or_throw();
    EXPECT_EQ(volume.odd, 1u) << odd;
    EXPECT_EQ(volume.high, expected.high) << odd;
    EXPECT_EQ(volume.unit, expected.unit) << odd;
    Grid mended = good;
    const float value = odd > 0 ? expected.high : 0;
    std::memcpy(&mended.values[4 * 100], &value, sizeof value);
    const BrickVolume same = make_brick_volume(mended).value_or_throw();
    ASSERT_EQ(volume.volume->slot_count(), same.volume->slot_count()) << odd;
    for (std::uint32_t slot = 0; slot < same.volume->slot_count(); ++slot)
      EXPECT_TRUE(std::ranges::equal(volume.volume->texels<std::uint16_t>(volume::ChannelId{0}, slot),
                                     same.volume->texels<std::uint16_t>(volume::ChannelId{0}, slot)))
          << odd;
  }
}

/// A level set whose surface is at x = 3, of voxels of 0.5 and a band of 1.5.
Grid level_set_of(GridClass grid_class) {
  Grid grid;
  grid.grid_class = grid_class;
  const float outside = 1.5f, inside = -1.5f;
  std::memcpy(grid.background.data(), &outside, sizeof outside);
  grid.world_from_index = glm::scale(glm::dmat4(1), glm::dvec3(0.5));
  Brick& brick = grid.bricks.emplace_back();
  for (std::size_t voxel = 0; voxel < kBrickVoxels; ++voxel) {
    const float distance = std::clamp(0.5f * (static_cast<float>(voxel % 8) - 3), inside, outside);
    brick.active[voxel / 64] |= std::uint64_t{1} << (voxel % 64);
    const auto* const bytes = reinterpret_cast<const std::byte*>(&distance);
    grid.values.insert(grid.values.end(), bytes, bytes + 4);
  }
  Tile tile{{-8, 0, 0}, 8, false, {}};
  std::memcpy(tile.value.data(), &inside, sizeof inside);
  grid.tiles = {tile};
  return grid;
}

// Whether or not the file says what it is.
TEST(BrickVolume, ALevelSetIsSolidInsideAndEmptyOutside) {
  for (const GridClass grid_class : {GridClass::level_set, GridClass::unknown}) {
    const Grid grid = level_set_of(grid_class);
    EXPECT_TRUE(is_level_set(grid));
    const BrickVolume bricks = make_brick_volume(grid).value_or_throw();
    for (int x = -7; x < 8; ++x)
      EXPECT_NEAR(filtered(*bricks.volume, glm::vec3(x, 4, 4) + 0.5f),
                  std::clamp((3.0f - static_cast<float>(x)) / 3, 0.0f, 1.0f), 1e-3f)
          << x;
  }
}

TEST(BrickVolume, WhatMayBeDensityIsNoLevelSet) {
  EXPECT_FALSE(is_level_set(level_set_of(GridClass::fog_volume)));
  Grid beyond = level_set_of(GridClass::unknown);
  const float far = 2;
  std::memcpy(beyond.values.data(), &far, sizeof far);
  EXPECT_FALSE(is_level_set(beyond));
  Grid without = level_set_of(GridClass::unknown);
  without.background = {};
  EXPECT_FALSE(is_level_set(without));
  EXPECT_FALSE(is_level_set(Grid{}));
}

TEST(BrickVolume, StoresTheNearestHalves) {
  std::mt19937 random(9);
  std::uniform_real_distribution<float> exponent(-28, 15.9f);
  Grid grid;
  grid.type = ValueType::float32;
  grid.bricks.resize(1);
  grid.bricks[0].active.fill(~std::uint64_t{0});
  std::array<float, kBrickVoxels> values{};
  for (float& value : values) value = std::exp2(exponent(random));
  values[0] = 1 + 1.0f / 2048;  // halfway between two
  const auto bytes = std::as_bytes(std::span(values));
  grid.values.assign(bytes.begin(), bytes.end());
  const BrickVolume bricks = make_brick_volume(grid).value_or_throw();
  const auto texels =
      bricks.volume->texels<std::uint16_t>(volume::ChannelId{0}, bricks.volume->slot_at(glm::ivec3(0)));
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_EQ(texels[111 + i % 8 + 10 * (i / 8 % 8) + 100 * (i / 64)],
              glm::packHalf1x16(values[i] / bricks.unit))
        << values[i];
}

TEST(BrickVolume, VectorsCountByTheirLength) {
  Grid velocity;
  velocity.type = ValueType::vec3f;
  velocity.bricks.resize(1);
  velocity.bricks[0].active[0] = 3;
  std::array<glm::vec3, kBrickVoxels> values{};
  values[0] = {2, -1, -2};
  values[1] = {0, 0, -5};
  const auto bytes = std::as_bytes(std::span(values));
  velocity.values.assign(bytes.begin(), bytes.end());
  const BrickVolume speed = make_brick_volume(velocity).value_or_throw();
  EXPECT_EQ(speed.high, 5);
  EXPECT_EQ(speed.sum, 3 + 5);
}

TEST(BrickVolume, RefusesMasksAndTakesNothing) {
  Grid grid;
  grid.type = ValueType::mask;
  EXPECT_EQ(make_brick_volume(grid).failure().code, ErrorCode::bad_input);
  grid.type = ValueType::float32;
  const BrickVolume nothing = make_brick_volume(grid).value_or_throw();
  EXPECT_EQ(nothing.volume->slot_count(), 0u);
  EXPECT_TRUE(nothing.ranges.empty());
}

Tile tile_of(glm::ivec3 origin, std::uint32_t edge, float value) {
  Tile tile{origin, edge, true, {}};
  std::memcpy(tile.value.data(), &value, sizeof value);
  return tile;
}

// 2^36 voxels of one value: level 6 has 8^3 bricks of them, of which the inner 6^3 are uniform, and a brick
// around.
TEST(BrickVolume, AHugeTileIsHalvedWithoutBecomingBricks) {
  Grid grid;
  grid.tiles = {tile_of(glm::ivec3(0), 4096, 0.75f)};
  const BrickVolume bricks = make_brick_volume(grid, {1000}).value_or_throw();
  EXPECT_EQ(bricks.level, 6);
  EXPECT_EQ(bricks.volume->uniform_bricks().size(), 6u * 6 * 6);
  EXPECT_EQ(bricks.volume->slot_count(), 1000u - 6 * 6 * 6);
  EXPECT_EQ(bricks.sum, 0.75 * 64 * 64 * 64);
  EXPECT_EQ(bricks.rms_error, 0) << "nothing of a constant is lost";
  EXPECT_EQ(filtered(*bricks.volume, glm::vec3(1, 20, 63)), 0.75f);
  const glm::dvec4 end = bricks.world_from_voxel * glm::dvec4(glm::dvec3(64), 1);
  EXPECT_EQ(glm::dvec3(end), glm::dvec3(4095.5)) << "where the last voxel ends";
}

// A tile of 128 beside bricks of another value, at every level from 0 on, against means of the file's voxels.
TEST(BrickVolume, TilesAndBricksAreHalvedAlike) {
  Grid grid = random_grid(11);
  grid.tiles = {tile_of({128, 0, 0}, 128, 1.5f), tile_of({24, 0, 8}, 8, 0.5f)};
  const auto value = [&](glm::ivec3 at) {
    for (const Tile& tile : grid.tiles)
      if (Box<int>{tile.origin, tile.origin + static_cast<int>(tile.edge)}.contains(at))
        return tile.edge == 8 ? 0.5f : 1.5f;
    return value_at(grid, at);
  };
  for (const auto& [max_bricks, level] : {std::pair(100000u, 0), {2000u, 1}, {300u, 2}}) {
    const BrickVolume bricks = make_brick_volume(grid, {max_bricks}).value_or_throw();
    ASSERT_EQ(bricks.level, level);
    const int edge = 1 << level;
    std::mt19937 random(1);
    for (int i = 0; i < 3000; ++i) {
      const glm::ivec3 at = (glm::ivec3(random() % 280, random() % 140, random() % 140) - 24) >> level;
      double sum = 0;
      for_each_in(Box<int>{at * edge, (at + 1) * edge}, [&](glm::ivec3 v) { sum += double{value(v)}; });
      const double mean = sum / (edge * edge * edge);
      EXPECT_NEAR(double{filtered(*bricks.volume, glm::vec3(at) + 0.5f)}, mean, mean / 2048) << level;
    }
  }
}

// Two bricks at the ends of index space would have a page table of 2^75 entries.
TEST(BrickVolume, BricksFarApartAreHalvedUntilATableFindsThem) {
  Grid grid;
  const float one = 1;
  for (const int at : {-(1 << 30), (1 << 30) - 8}) {
    Brick& brick = grid.bricks.emplace_back();
    brick.origin = glm::ivec3(at);
    brick.active.fill(~std::uint64_t{0});
    for (std::size_t voxel = 0; voxel < kBrickVoxels; ++voxel) {
      const auto* const bytes = reinterpret_cast<const std::byte*>(&one);
      grid.values.insert(grid.values.end(), bytes, bytes + sizeof one);
    }
  }
  const BrickVolume bricks = make_brick_volume(grid, {.max_pages = kFewestVolumePages}).value_or_throw();
  EXPECT_GT(bricks.level, 20);
  const volume::PageTable& pages = bricks.volume->pages();
  EXPECT_LE(pages.root().size() + pages.nodes().size(), kFewestVolumePages);
  EXPECT_NEAR(bricks.sum * std::exp2(3 * bricks.level), 2 * 512, 1e-3) << "the mass remains";
  EXPECT_NEAR(bricks.rms_error, 1, 1e-3) << "all that was 1 is nearly 0";
}

// Random points never leave the range of their brick, and its ends are values at the points where filtering
// has its extremes: voxel centres and middles between texels on faces.
TEST(BrickVolume, TheRangeOfABrickIsThatOfItsSamples) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> inside(0, 8);
  for (const float factor : {1.0f, 1e-6f}) {
    Grid grid = random_grid(9);
    change_values(grid, [&](float value) { return value * factor * (random() % 64 == 0 ? 50.0f : 1.0f); });
    const BrickVolume bricks = make_brick_volume(grid).value_or_throw();
    ASSERT_EQ(bricks.ranges.size(), bricks.volume->slot_count());
    for (std::uint32_t slot = 0; slot < bricks.volume->slot_count(); ++slot) {
      const ValueRange range = bricks.ranges[slot];
      const glm::vec3 low(bricks.volume->brick_of(slot) * 8);
      // The sampler of this test rounds each of its 8 products and sums.
      const float rounding = 16 * range.high * 6e-8f;
      for (int i = 0; i < 300; ++i) {
        glm::vec3 p = low + glm::vec3(inside(random), inside(random), inside(random));
        if (i % 3 == 0) p[i / 3 % 3] = low[i / 3 % 3];  // on a face
        const float value = filtered(*bricks.volume, p);
        EXPECT_GE(value, range.low - rounding);
        EXPECT_LE(value, range.high + rounding);
      }
      float least = range.high, most = 0;
      for_each_in(Box<int>{glm::ivec3(0), glm::ivec3(10)}, [&](glm::ivec3 at) {
        // A face belongs to the next brick: the sampler takes the last float before it.
        const glm::vec3 q = glm::clamp(glm::vec3(at) - 0.5f, 0.0f, 7.9999995f);
        const float value = filtered_in(*bricks.volume, slot, q);
        least = std::min(least, value);
        most = std::max(most, value);
      });
      EXPECT_NEAR(least, range.low, 1e-6f * range.high + rounding);
      EXPECT_NEAR(most, range.high, 1e-6f * range.high + rounding);
    }
  }
}

/// A ball of 3, beyond a plane of noise.
Grid ball_with_noise() {
  std::mt19937 random(21);
  std::uniform_real_distribution<float> draw(1, 4);
  Grid grid;
  grid.name = "density";
  for_each_in(Box<int>{glm::ivec3(-5), glm::ivec3(5)}, [&](glm::ivec3 at) {
    Brick& brick = grid.bricks.emplace_back();
    brick.origin = at * 8;
    for (int voxel = 0; voxel < static_cast<int>(kBrickVoxels); ++voxel) {
      const glm::ivec3 p = brick.origin + glm::ivec3(voxel & 7, voxel >> 3 & 7, voxel >> 6);
      const float value = glm::length(glm::vec3(p)) > 37 ? 0 : p.x > 20 ? draw(random) : 3.0f;
      if (value > 0) brick.active[static_cast<std::size_t>(voxel / 64)] |= std::uint64_t{1} << (voxel % 64);
      const auto* const bytes = reinterpret_cast<const std::byte*>(&value);
      grid.values.insert(grid.values.end(), bytes, bytes + sizeof value);
    }
  });
  return grid;
}

TEST(BrickVolume, BricksOfOneValueTakeNoTexelsAndFilterAlike) {
  const Grid grid = ball_with_noise();
  const BrickVolume all = make_brick_volume(grid, {.may_be_uniform = false}).value_or_throw();
  const BrickVolume bricks = make_brick_volume(grid).value_or_throw();
  EXPECT_EQ(all.volume->uniform_bricks().size(), 0u);
  EXPECT_EQ(bricks.volume->uniform_bricks().size() + bricks.volume->slot_count(), all.volume->slot_count());
  // Of the half ball up to the plane, bricks that with their aprons are inside.
  EXPECT_GT(bricks.volume->uniform_bricks().size(), 60u);
  EXPECT_EQ(bricks.ranges.size(), bricks.volume->slot_count());
  std::mt19937 random(22);
  std::uniform_real_distribution<float> draw(-41, 41);
  for (int i = 0; i < 20000; ++i) {
    const glm::vec3 p(draw(random), draw(random), draw(random));
    // Weights that add up to 1 but for rounding.
    ASSERT_NEAR(filtered(*bricks.volume, p), filtered(*all.volume, p), 4e-6f)
        << p.x << ' ' << p.y << ' ' << p.z;
  }
  EXPECT_EQ(bricks.sum, all.sum);
  EXPECT_EQ(bricks.volume->layout().bounds_max, all.volume->layout().bounds_max);
  // A room that the texels fit into is enough.
  EXPECT_EQ(make_brick_volume(grid, {bricks.volume->slot_count()}).value_or_throw().level, 0);
  EXPECT_GE(make_brick_volume(grid, {bricks.volume->slot_count() - 1}).value_or_throw().level, 1);
  // Halves of a volume with uniform bricks are those of one without.
  const BrickVolume a = make_preview(bricks, 40), b = make_preview(all, 40);
  for (int i = 0; i < 2000 && a.level == b.level; ++i) {
    const glm::vec3 p = glm::vec3(draw(random), draw(random), draw(random)) * 0.5f;
    ASSERT_NEAR(filtered(*a.volume, p), filtered(*b.volume, p), 4e-6f);
  }
  EXPECT_NEAR(a.sum * std::exp2(3 * a.level), b.sum * std::exp2(3 * b.level),
              b.sum / 512 * std::exp2(3 * b.level));
}

TEST(BrickVolume, APreviewIsTheSameAtALowerResolution) {
  const Grid grid = random_grid(13);
  const BrickVolume fine = make_brick_volume(grid).value_or_throw();
  const BrickVolume preview = make_preview(fine, 24);
  EXPECT_GE(preview.level, 1);
  EXPECT_LE(preview.volume->slot_count(), 24u);
  EXPECT_EQ(preview.unit, fine.unit);
  // Halves round by 2^-11 of a value.
  EXPECT_NEAR(preview.sum * std::exp2(3 * preview.level), fine.sum, fine.sum / 2048);
  // The same bounds in the world: light that is stored by them holds for both.
  for (const bool high : {false, true}) {
    const shared::VolumeLayout &a = fine.volume->layout(), &b = preview.volume->layout();
    const glm::dvec4 at(high ? a.bounds_max : a.bounds_min, 1), same(high ? b.bounds_max : b.bounds_min, 1);
    EXPECT_LT(glm::length(glm::dvec4(fine.world_from_voxel * at) - preview.world_from_voxel * same), 1e-5);
  }
  // A brick wherever the fine one has one, for what glows there.
  for (std::uint32_t slot = 0; slot < fine.volume->slot_count(); ++slot)
    EXPECT_NE(preview.volume->slot_at(fine.volume->brick_of(slot) >> preview.level),
              volume::SparseVolume::kNoSlot);
}

}  // namespace
}  // namespace brume::grids
