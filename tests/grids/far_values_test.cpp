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

// Floats have no places between voxels as far out as 1e8.
TEST(FarValues, VoxelsAreCountedFromNearby) {
  const glm::ivec3 far(100'000'000, 8, -80'000'000);
  const BrickVolume near = make_brick_volume(grid_at({0, 0, 0}, kNever, 0)).value_or_throw();
  const BrickVolume out = make_brick_volume(grid_at(far, kNever, 0)).value_or_throw();
  ASSERT_EQ(out.volume->slot_count(), near.volume->slot_count());
  EXPECT_EQ(out.world_from_voxel,
            glm::translate(glm::dmat4(1), 0.5 * glm::dvec3(far)) * near.world_from_voxel);
  for (std::uint32_t slot = 0; slot < out.volume->slot_count(); ++slot) {
    const std::uint32_t same = near.volume->slot_at(out.volume->brick_of(slot));
    ASSERT_NE(same, volume::SparseVolume::kNoSlot);
    EXPECT_TRUE(std::ranges::equal(out.volume->texels<std::uint16_t>(volume::ChannelId{0}, slot),
                                   near.volume->texels<std::uint16_t>(volume::ChannelId{0}, same)));
  }
}

}  // namespace
}  // namespace brume::grids
