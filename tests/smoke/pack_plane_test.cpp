#include "smoke/pack_plane.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace brume::smoke {
namespace {

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
}  // namespace brume::smoke
