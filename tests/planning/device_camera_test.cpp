#include "planning/device_camera.hpp"

#include <gtest/gtest.h>

#include <random>

namespace brume::planning {
namespace {

TEST(DeviceCamera, RaysAndProjectionAgree) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> value(-5, 5), share(0, 1);
  for (int i = 0; i < 200; ++i) {
    const scene::Camera camera{{value(random), value(random), value(random)},
                               {value(random), value(random), value(random)},
                               0.2f + 2 * share(random)};
    const glm::uvec2 size(1 + random() % 100, 1 + random() % 100);
    const shared::Camera c = device_camera(camera, size);
    const glm::vec2 ndc(2 * share(random) - 1, 2 * share(random) - 1);
    const float along = 0.1f + 20 * share(random);
    const glm::vec3 point = c.eye_world + along * (c.forward + ndc.x * c.right - ndc.y * c.up);
    const glm::vec4 clip = c.clip_from_world * glm::vec4(point, 1);
    EXPECT_NEAR(clip.w, along, 1e-4f * (1 + along));
    EXPECT_NEAR(clip.x / clip.w, ndc.x, 2e-3f);
    EXPECT_NEAR(clip.y / clip.w, ndc.y, 2e-3f);
    EXPECT_NEAR(clip.z / clip.w, kNearPlane / along, 1e-4f);
  }
}

TEST(DeviceCamera, LooksStraightDownAndAtItself) {
  for (const glm::vec3 target : {glm::vec3(0, -1, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 0)}) {
    const shared::Camera c = device_camera({glm::vec3(0), target, 1}, {16, 9});
    for (const glm::vec3 axis : {c.forward, c.right, c.up}) {
      EXPECT_TRUE(std::isfinite(glm::length(axis)));
      EXPECT_GT(glm::length(axis), 0.1f);
    }
  }
}

}  // namespace
}  // namespace brume::planning
