// Values and places far from all others.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "grids/brick_volume.hpp"

namespace brume::grids {
namespace {

/// Bricks of values in [1, 2) but for one in `rare`, which is `large`; their first one at an index.
Grid grid_at(glm::ivec3 origin, std::uint32_t rare, float large) {
  Grid grid;
  grid.world_from_index = glm::scale(glm::dmat4(1), glm::dvec3(0.5));
  std::minstd_rand random(3);
  for (const int x : {0, 8, 24}) {
    Brick& brick = grid.bricks.emplace_back();
    brick.origin = origin + glm::ivec3(x, 0, 0);
    brick.active.fill(~std::uint64_t{0});
    for (std::uint32_t voxel = 0; voxel < kBrickVoxels; ++voxel) {
      const float usual = 1 + static_cast<float>(random() % 1000) / 1000;
      const float value = voxel % rare == rare / 2 ? large : usual;
      const auto* const bytes = reinterpret_cast<const std::byte*>(&value);
      grid.values.insert(grid.values.end(), bytes, bytes + sizeof value);
    }
  }
  return grid;
}

constexpr std::uint32_t kNever = 2 * kBrickVoxels;

TEST(FarValues, AFewAreTheLargestOfTheRest) {
  Grid grid = grid_at({0, 0, 0}, kNever, 0);
  const float usual = make_brick_volume(grid).value_or_throw().high;
  for (const float value : {1e4f, 1e8f, 1e20f}) {
    std::memcpy(grid.values.data(), &value, sizeof value);
    const BrickVolume volume = make_brick_volume(grid).value_or_throw();
    EXPECT_EQ(volume.odd, 1u) << value;
    EXPECT_EQ(volume.high, usual) << value;
  }
}

TEST(FarValues, AHundredthOfAllCounts) {
  const BrickVolume volume = make_brick_volume(grid_at({0, 0, 0}, 100, 1e8f)).value_or_throw();
  EXPECT_EQ(volume.odd, 0u);
  EXPECT_EQ(volume.high, 1e8f);
}

/// Expects every brick of `near` in `out`, `far` indices away, with the same halves, and none beside them.
void expect_moved(const BrickVolume& near, const BrickVolume& out, glm::ivec3 far) {
  const std::uint32_t slots = near.volume->slot_count();
  ASSERT_GE(out.volume->slot_count(), slots);
  // Voxels of `out` from those of `near`.
  const glm::dvec3 moved(glm::inverse(out.world_from_voxel) *
                         (glm::translate(glm::dmat4(1), 0.5 * glm::dvec3(far)) * near.world_from_voxel[3]));
  const glm::ivec3 bricks(glm::round(moved / 8.0));
  EXPECT_EQ(glm::dvec3(8 * bricks), moved);
  for (std::uint32_t slot = 0; slot < slots; ++slot) {
    const std::uint32_t same = out.volume->slot_at(near.volume->brick_of(slot) + bricks);
    ASSERT_NE(same, volume::SparseVolume::kNoSlot);
    EXPECT_TRUE(std::ranges::equal(near.volume->texels<std::uint16_t>(volume::ChannelId{0}, slot),
                                   out.volume->texels<std::uint16_t>(volume::ChannelId{0}, same)));
  }
}

/// Farthest coordinate of a brick [voxels].
int farthest_of(const BrickVolume& volume, glm::ivec3 at) {
  const std::uint32_t slot = volume.volume->slot_at(at);
  if (slot == volume::SparseVolume::kNoSlot) return 1 << 30;
  const glm::ivec3 place = 8 * glm::abs(at);
  return std::max({place.x, place.y, place.z});
}

// Floats have no places between voxels as far out as 1e8.
TEST(FarValues, VoxelsAreCountedFromNearby) {
  const glm::ivec3 far(100'000'000, 8, -80'000'000);
  const BrickVolume near = make_brick_volume(grid_at({0, 0, 0}, kNever, 0)).value_or_throw();
  const BrickVolume out = make_brick_volume(grid_at(far, kNever, 0)).value_or_throw();
  EXPECT_EQ(out.volume->slot_count(), near.volume->slot_count());
  expect_moved(near, out, far);
  // From less than the largest tile away: floats have 1/1024 of a voxel there.
  for (std::uint32_t slot = 0; slot < out.volume->slot_count(); ++slot)
    EXPECT_LE(farthest_of(out, out.volume->brick_of(slot)), 4096 + 40);
}

// One brick out there does not take the others along.
TEST(FarValues, AStrayBrickDoesNotMoveTheOthers) {
  Grid grid = grid_at({0, 0, 0}, kNever, 0);
  const BrickVolume near = make_brick_volume(grid).value_or_throw();
  for (const int x : {-6'000'000, 6'000'000}) {
    Grid strays = grid;
    const std::ptrdiff_t at = x < 0 ? 0 : 3;
    Brick far = grid.bricks[0];
    far.origin.x = x;
    strays.bricks.insert(strays.bricks.begin() + at, far);
    const std::ptrdiff_t bytes = kBrickVoxels * sizeof(float);
    strays.values.insert(strays.values.begin() + at * bytes, grid.values.begin(),
                         grid.values.begin() + bytes);
    const BrickVolume out = make_brick_volume(strays).value_or_throw();
    EXPECT_EQ(out.level, 0);
    expect_moved(near, out, {0, 0, 0});
    EXPECT_EQ(out.world_from_voxel, near.world_from_voxel);
  }
}

// A cube of one value stays where it is at every resolution, as far out as near.
TEST(FarValues, TilesAreHalvedInPlace) {
  const auto tiles_at = [](glm::ivec3 far) {
    Grid grid;
    grid.type = ValueType::float32;
    const float one = 1;
    for (const int x : {0, 128}) {
      Tile& tile = grid.tiles.emplace_back();
      tile.origin = far + glm::ivec3(x, 0, 0);
      tile.edge = 128;
      tile.active = true;
      std::memcpy(tile.value.data(), &one, sizeof one);
    }
    return grid;
  };
  const glm::ivec3 far(4096 * 30'000 + 128, 128, 0);
  const BrickVolumeOptions small{.max_bricks = 64, .may_be_uniform = false};
  const BrickVolume near = make_brick_volume(tiles_at({128, 128, 0}), small).value_or_throw();
  const BrickVolume out = make_brick_volume(tiles_at(far), small).value_or_throw();
  ASSERT_GT(near.level, 0);
  EXPECT_EQ(out.level, near.level);
  EXPECT_EQ(out.rms_error, near.rms_error);
  const auto low_of = [](const BrickVolume& volume) {
    return glm::dvec3(volume.world_from_voxel * glm::dvec4(volume.volume->layout().bounds_min, 1));
  };
  EXPECT_EQ(low_of(out) - low_of(near), glm::dvec3(far - glm::ivec3(128, 128, 0)));
}

}  // namespace
}  // namespace brume::grids
