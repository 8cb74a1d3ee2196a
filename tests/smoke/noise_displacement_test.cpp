#include "smoke/noise_displacement.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/packing.hpp>

#include "sim/world.hpp"
#include "tests/smoke/displacements.hpp"
#include "voxel/surface_planes.hpp"

namespace brume::smoke {
namespace {

// NoiseAdvectionTest compares with the device.
class NoiseDisplacementTest : public ::testing::Test {
 protected:
  NoiseDisplacementTest() {
    sim::ThrowSmoke event;
    event.from = event.at = sim::position_from_metres({8, 8, 8});
    event.smoke.voxels = 8000;
    world_.append(event).value_or_throw();
    world_.advance_to(300);
    volume_.update(world_);
    look_.swirl = 0.2f;
    look_.swirl_width = 3;
  }
  std::vector<glm::vec3> displacement() const {
    return displacements_of(NoiseDisplacement(volume_, world_.state(), look_, 300.0 / 64, 12), volume_);
  }

  voxel::BitGrid grid_{{glm::ivec3(32), 0.5f, glm::vec3(0)}};
  voxel::SurfacePlanes planes_;
  sim::World world_{grid_};
  SmokeVolume volume_{grid_, planes_};
  shared::SmokeLook look_{};
};

// Also of the last point along each axis, which has none behind it.
TEST(GrowthAtTest, OfAPointIsThePointsAlone) {
  constexpr std::uint32_t kPoints = shared::kDisplacementsPerBrick, kNotANumber = 0x7e007e00;
  std::vector<glm::uvec2> points(2 * kPoints, glm::uvec2(kNotANumber));
  for (std::uint32_t i = 0; i < kPoints; ++i)
    points[i] = {glm::packHalf2x16({i, 1}), glm::packHalf2x16({2, 0.5f})};
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    const glm::ivec3 texel = 2 * glm::ivec3(i % 6, i / 6 % 6, i / 36);
    EXPECT_EQ(growth_at(std::span(points).first<kPoints>(), texel), glm::vec4(i, 1, 2, 0.5f)) << i;
  }
}

TEST_F(NoiseDisplacementTest, OfGrowthPointsAlongIt) {
  look_.swirl = 0;
  const auto displaced = displacement();
  ASSERT_EQ(displaced.size(), std::size_t{shared::kTexelsPerBrick} * volume_.slot_count());
  const sim::Cloud& cloud = *world_.state().clouds.at(0).cloud;
  const float grown = cloud_motion(cloud, 64, 300.0 / 64, 12).grown;
  int compared = 0, still = 0;
  for (std::size_t i = 0; i < displaced.size(); ++i) {
    const auto slot = static_cast<std::uint32_t>(i / shared::kTexelsPerBrick);
    const auto n = static_cast<int>(i % shared::kTexelsPerBrick);
    const glm::ivec3 voxel = 8 * volume_.brick_of(slot) + glm::ivec3(n % 10, n / 10 % 10, n / 100) - 1;
    still += displaced[i] == glm::vec3(0);
    // Where all voxels around belong to the cloud, its growth is a straight line.
    bool inside = true;
    for (int k = 0; k < 125 && inside; ++k)
      inside = cloud.voxels().contains(voxel + glm::ivec3(k % 5, k / 5 % 5, k / 25) - 2);
    if (!inside) continue;
    const glm::vec3 from_source = 0.5f * glm::vec3(voxel - cloud.origin().source);
    // Half floats of at most 8 m, which round by 2^-9 m; paths are sums of floats.
    ++compared;
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(displaced[i][axis], grown * from_source[axis], std::abs(grown) * 0x1p-9 + 1e-5);
  }
  EXPECT_GT(compared, 1000);
  EXPECT_GT(still, 1000);  // away from the smoke
}

}  // namespace
}  // namespace brume::smoke
