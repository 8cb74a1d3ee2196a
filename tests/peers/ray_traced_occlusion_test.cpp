// What script/compare-decals takes for the truth: against form factors.
#include "bench/decals/ray_traced_occlusion.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "tests/reference/occlusion.hpp"

namespace brume::decals {
namespace {

std::vector<voxel::Triangle> rectangle(glm::vec2 low, glm::vec2 high, float y) {
  const glm::vec3 a(low.x, y, low.y), b(high.x, y, low.y), c(high.x, y, high.y), d(low.x, y, high.y);
  return {{a, b, c}, {a, c, d}};
}

// Of 4096 rays, one in each of as many equal parts of the disk, those whose parts an edge crosses may be
// wrong: about 64 along each of four edges, and their neighbours. They err to both sides at random: 512 of
// them by a deviation of sqrt(512) / 2 / 4096 = 0.0028.
TEST(RayTracedOcclusionTest, IsTheFormFactorOfARectangle) {
  constexpr double kBound = 5 * 0.0028;
  for (const float height : {0.3f, 1.0f, 3.0f}) {
    const RayTracedOcclusion occluders(rectangle({-0.7f, -1}, {1.5f, 0.4f}, height), 4096);
    const double expected =
        reference::form_factor_of_rectangle({-0.7, -1}, {1.5, double{0.4f}}, double{height});
    for (const std::uint32_t seed : {0u, 1u, 77u}) {
      EXPECT_NEAR(occluders.at(glm::dvec3(0), {0, 1, 0}, seed, 0), expected, kBound) << height;
      EXPECT_EQ(occluders.at(glm::dvec3(0), {0, -1, 0}, seed, 0), 0);
    }
  }
}

TEST(RayTracedOcclusionTest, IsTheSameWhereverTheNormalPoints) {
  // A half of the sky, up to a normal in its plane: half of it.
  const RayTracedOcclusion half(rectangle({-1e4f, -1e4f}, {1e4f, 1e4f}, 1), 1024);
  EXPECT_NEAR(half.at(glm::dvec3(0), {0, 1, 0}, 3, 0), 1, 0.001);
  for (const glm::dvec3 normal : {glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1), glm::dvec3(-0.6, 0, 0.8)})
    EXPECT_NEAR(half.at(glm::dvec3(0), normal, 3, 0), 0.5, 0.02);
  EXPECT_EQ(RayTracedOcclusion({}, 16).at(glm::dvec3(0), {0, 1, 0}, 0, 0), 0);
}

}  // namespace
}  // namespace brume::decals
