#include "grids/color_bricks.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>

namespace brume::grids {
namespace {

template <typename T>
void append(Grid& grid, T value) {
  const auto* const bytes = reinterpret_cast<const std::byte*>(&value);
  grid.values.insert(grid.values.end(), bytes, bytes + sizeof value);
}

/// A brick of density 1 at the origin.
Grid cube() {
  Grid grid;
  grid.name = "density";
  grid.bricks.emplace_back().active.fill(~std::uint64_t{0});
  for (std::size_t voxel = 0; voxel < kBrickVoxels; ++voxel) append(grid, 1.0f);
  return grid;
}

/// A brick of colours (x / 8, y / 8, z / 8), active where x < `end`.
Grid gradient(int end = 8) {
  Grid grid;
  grid.name = "Cd";
  grid.type = ValueType::vec3f;
  Brick& brick = grid.bricks.emplace_back();
  for (std::size_t voxel = 0; voxel < kBrickVoxels; ++voxel) {
    const glm::ivec3 p(voxel & 7, voxel >> 3 & 7, voxel >> 6);
    if (p.x < end) brick.active[voxel / 64] |= std::uint64_t{1} << (voxel % 64);
    append(grid, glm::vec3(p) / 8.0f);
  }
  return grid;
}

/// The colour of a voxel.
glm::vec3 texel(const volume::SparseVolume& bricks, glm::ivec3 voxel) {
  const std::uint32_t slot = bricks.slot_at(voxel >> 3);
  if (slot == volume::SparseVolume::kNoSlot) return glm::vec3(-1);
  const glm::ivec3 in = (voxel & 7) + 1;
  const auto texels = bricks.texels<std::uint64_t>(volume::ChannelId{0}, slot);
  return glm::vec3(glm::unpackHalf4x16(texels[static_cast<std::size_t>(in.x + 10 * (in.y + 10 * in.z))]));
}

TEST(ColorBricks, HaveTheSlotsOfTheDensityAndTheColoursOfItsVoxels) {
  const BrickVolume density = make_brick_volume(cube()).value_or_throw();
  const auto colors = make_color_bricks(gradient(), density).value_or_throw();
  ASSERT_EQ(colors->slot_count(), density.volume->slot_count());
  for (std::uint32_t slot = 0; slot < colors->slot_count(); ++slot)
    EXPECT_EQ(colors->brick_of(slot), density.volume->brick_of(slot));
  for (int i = 0; i < 512; ++i) {
    const glm::ivec3 p(i & 7, i >> 3 & 7, i >> 6);
    EXPECT_EQ(texel(*colors, p), glm::vec3(p) / 8.0f);
  }
  // The rim that filtering reaches has the colours beside it, and what is beyond is white.
  EXPECT_EQ(texel(*colors, {3, -1, 4}), glm::vec3(3, 0.5f, 4) / 8.0f * glm::vec3(1, 0, 1));
  EXPECT_EQ(texel(*colors, {3, -3, 4}), glm::vec3(1));
}

TEST(ColorBricks, VoxelsThatAreNotActiveHaveNoColour) {
  const BrickVolume density = make_brick_volume(cube()).value_or_throw();
  const auto colors = make_color_bricks(gradient(4), density).value_or_throw();
  EXPECT_EQ(texel(*colors, {4, 3, 3}), glm::vec3(3, 3, 3) / 8.0f) << "the mean of nine neighbours at x = 3";
  EXPECT_EQ(texel(*colors, {6, 3, 3}), glm::vec3(1));
}

TEST(ColorBricks, AnotherLatticeIsFiltered) {
  Grid fine = cube();
  fine.world_from_index =
      glm::translate(glm::dmat4(1), glm::dvec3(2.25, 2, 2)) * glm::scale(glm::dmat4(1), glm::dvec3(0.5));
  const BrickVolume density = make_brick_volume(fine).value_or_throw();
  const auto colors = make_color_bricks(gradient(), density).value_or_throw();
  // Voxel (i, j, k) is at (2.25 + i / 2, 2 + j / 2, 2 + k / 2) of a gradient that is linear.
  for (const glm::ivec3 p : {glm::ivec3(0), glm::ivec3(3, 5, 7), glm::ivec3(7, 1, 2)})
    EXPECT_LT(glm::length(texel(*colors, p) - (glm::vec3(2.25f, 2, 2) + glm::vec3(p) / 2.0f) / 8.0f), 1e-3f);
}

TEST(ColorBricks, LimitsWhatIsNoAlbedoAndRefusesOtherTypes) {
  const BrickVolume density = make_brick_volume(cube()).value_or_throw();
  Grid odd = gradient();
  odd.values.clear();
  for (std::size_t voxel = 0; voxel < kBrickVoxels; ++voxel) append(odd, glm::vec3(-1, 7, NAN));
  EXPECT_EQ(texel(*make_color_bricks(odd, density).value_or_throw(), {1, 2, 3}), glm::vec3(0, 1, 0));
  const auto refused = make_color_bricks(cube(), density);
  EXPECT_EQ(refused.failure().message,
            "grid density: holds values of float32; expected colours, which are vec3f or vec3d");
  // A tile of one colour.
  Grid tiled;
  tiled.type = ValueType::vec3f;
  Tile& tile = tiled.tiles.emplace_back();
  tile.edge = 128;
  tile.active = true;
  const glm::vec3 red(1, 0, 0);
  std::memcpy(tile.value.data(), &red, sizeof red);
  EXPECT_EQ(texel(*make_color_bricks(tiled, density).value_or_throw(), {1, 2, 3}), red);
}

/// A channel of the gradient, multiplied by `factor` at each voxel.
template <typename Factor>
Grid channel(int of, int end, Factor factor) {
  Grid grid;
  grid.name = std::string("color_") + "rgb"[of];
  Brick& brick = grid.bricks.emplace_back();
  for (std::size_t voxel = 0; voxel < kBrickVoxels; ++voxel) {
    const glm::ivec3 p(voxel & 7, voxel >> 3 & 7, voxel >> 6);
    if (p.x < end) brick.active[voxel / 64] |= std::uint64_t{1} << (voxel % 64);
    append(grid, factor(p) * static_cast<float>(p[of]) / 8.0f);
  }
  return grid;
}

std::vector<Grid> channels(int end) {
  std::vector<Grid> grids;
  for (int of = 0; of < 3; ++of) grids.push_back(channel(of, end, [](glm::ivec3) { return 1.0f; }));
  return grids;
}

TEST(ColorBricks, ChannelsAreTheColoursOfVectors) {
  Grid fine = cube();
  fine.world_from_index = glm::scale(glm::dmat4(1), glm::dvec3(0.5));
  for (const Grid& lattice : {cube(), fine})
    for (const int end : {8, 4}) {
      const BrickVolume density = make_brick_volume(lattice).value_or_throw();
      const std::vector<Grid> parts = channels(end);
      const auto joined =
          make_color_bricks({{&parts[0], &parts[1], &parts[2]}, nullptr}, density).value_or_throw();
      const auto vectors = make_color_bricks(gradient(end), density).value_or_throw();
      ASSERT_EQ(joined->slot_count(), vectors->slot_count());
      for (int i = 0; i < 1000; ++i) {
        const glm::ivec3 p = glm::ivec3(i % 10, i / 10 % 10, i / 100) - 1;
        EXPECT_EQ(texel(*joined, p), texel(*vectors, p)) << i;
      }
    }
}

// Each channel has voxels at places of its own, of which the colour is linear.
TEST(ColorBricks, ChannelsAtOtherPlacesAreFiltered) {
  const BrickVolume density = make_brick_volume(cube()).value_or_throw();
  std::vector<Grid> parts = channels(8);
  parts[1].world_from_index = glm::translate(glm::dmat4(1), glm::dvec3(0, 0.25, 0));
  parts[2].world_from_index = glm::scale(glm::dmat4(1), glm::dvec3(1, 1, 2));
  const auto joined =
      make_color_bricks({{&parts[0], &parts[1], &parts[2]}, nullptr}, density).value_or_throw();
  for (const glm::ivec3 p : {glm::ivec3(1, 2, 3), glm::ivec3(7, 5, 6), glm::ivec3(3, 1, 0)}) {
    const glm::vec3 expected(float(p.x), float(p.y) - 0.25f, float(p.z) / 2);
    EXPECT_LT(glm::length(texel(*joined, p) - expected / 8.0f), 1e-3f) << p.x;  // halves
  }
  parts[1].world_from_index = glm::dmat4(0);
  EXPECT_EQ(make_color_bricks({{&parts[0], &parts[1], &parts[2]}, nullptr}, density).failure().message,
            "grid color_g: its transform has no inverse");
}

// What is multiplied by the density is divided by it; where there is none, neither is a colour.
TEST(ColorBricks, ChannelsAreDividedByTheDensity) {
  const auto dense = [](glm::ivec3 p) { return 0.25f * static_cast<float>(p.y); };
  Grid weight = cube();
  weight.values.clear();
  for (std::size_t voxel = 0; voxel < kBrickVoxels; ++voxel)
    append(weight, dense(glm::ivec3(voxel & 7, voxel >> 3 & 7, voxel >> 6)));
  const BrickVolume density = make_brick_volume(weight).value_or_throw();
  std::vector<Grid> parts;
  for (int of = 0; of < 3; ++of) parts.push_back(channel(of, 8, dense));
  const auto joined =
      make_color_bricks({{&parts[0], &parts[1], &parts[2]}, &weight}, density).value_or_throw();
  for (int i = 0; i < 512; ++i) {
    const glm::ivec3 p(i & 7, i >> 3 & 7, i >> 6);
    if (p.y > 0) {
      EXPECT_LT(glm::length(texel(*joined, p) - glm::vec3(p) / 8.0f), 1e-3f) << i;
    }
  }
  // Black smoke has no voxels of colour.
  for (Grid& part : parts) {
    part.bricks.clear();
    part.values.clear();
  }
  const auto black =
      make_color_bricks({{&parts[0], &parts[1], &parts[2]}, &weight}, density).value_or_throw();
  EXPECT_EQ(texel(*black, {3, 4, 5}), glm::vec3(0));
}

TEST(ColorBricks, WhatFallsWithTheDensityIsMultipliedByIt) {
  // A density of (x + 1) / 8, and colours that are so much of it, and so much beside it.
  const auto ramp = [](float per_density, float beside) {
    Grid grid = cube();
    for (std::size_t voxel = 0; voxel < kBrickVoxels; ++voxel) {
      const float value = per_density * static_cast<float>((voxel & 7) + 1) / 8 + beside;
      std::memcpy(&grid.values[voxel * sizeof value], &value, sizeof value);
    }
    return grid;
  };
  const Grid density = ramp(1, 0), none = ramp(0, 0);
  const auto decided = [&](const Grid& color) { return are_multiplied({&none, &color, &none}, density); };
  EXPECT_TRUE(decided(ramp(0.6f, 0)));
  EXPECT_TRUE(decided(ramp(1, 0)));
  EXPECT_FALSE(decided(ramp(0, 0.05f))) << "a dark colour of its own";
  EXPECT_FALSE(decided(ramp(0, 0.5f))) << "more than the density in parts";
  EXPECT_FALSE(decided(none));
  Grid moved = ramp(0.6f, 0);
  moved.world_from_index[3].x = 1;
  EXPECT_FALSE(decided(moved));
  EXPECT_FALSE(are_multiplied({&none, &none, &none}, none));
}

}  // namespace
}  // namespace brume::grids
