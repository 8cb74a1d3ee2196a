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

TEST(DeviceCamera, RaysAndProjectionAgreeInAParallelView) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> value(-5, 5), share(0, 1);
  for (int i = 0; i < 200; ++i) {
    scene::Camera camera{{value(random), value(random), value(random)},
                         {value(random), value(random), value(random)}};
    const glm::vec2 low(value(random), value(random)), size(1 + share(random), 0.5f + share(random));
    camera.frustum = {low.x, low.x + size.x, low.y, low.y + size.y};
    const ViewSample jittered{{share(random) - 0.5f, share(random) - 0.5f}};
    const glm::uvec2 size_px(1 + random() % 100, 1 + random() % 100);
    const shared::Camera c = device_camera(camera, size_px, jittered, Projection::parallel);
    EXPECT_NEAR(pixel_width(c, size_px).at(value(random)), size.y / static_cast<float>(size_px.y), 1e-6f);

    // A point of the picture, and its distance in metres from the left and from below.
    const glm::vec2 ndc(2 * share(random) - 1, 2 * share(random) - 1);
    const float along = 0.1f + 20 * share(random);
    const glm::vec3 point =
        c.eye_world + (c.shift.x + ndc.x) * c.right + (c.shift.y - ndc.y) * c.up + along * c.forward;
    const glm::vec4 seen = seen_from_world(c) * glm::vec4(point, 1);
    EXPECT_NEAR(seen.x / seen.z, ndc.x, 1e-4f);
    EXPECT_NEAR(seen.y / seen.z, ndc.y, 1e-4f);
    EXPECT_NEAR(seen.w, along, 1e-4f);
    const glm::vec2 px = (0.5f * ndc + 0.5f) * glm::vec2(size_px) + jittered.pixel,
                    metres =
                        glm::vec2(px.x, static_cast<float>(size_px.y) - px.y) / glm::vec2(size_px) * size +
                        low;
    EXPECT_NEAR(glm::dot(point - c.eye_world, glm::normalize(c.right)), metres.x, 1e-4f);
    EXPECT_NEAR(glm::dot(point - c.eye_world, glm::normalize(c.up)), metres.y, 1e-4f);
  }
}

// A picture that the view axis meets anywhere, even outside.
TEST(DeviceCamera, SidesHaveTheTangentsOfTheFrustum) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> value(-2, 2), width(0.1f, 2);
  for (int i = 0; i < 200; ++i) {
    scene::Frustum frustum{value(random), 0, value(random), 0};
    frustum.right = frustum.left + width(random);
    frustum.up = frustum.down + width(random);
    scene::Camera camera{{1, 2, 3}, {2, 1, value(random)}, 1};
    camera.frustum = frustum;
    const shared::Camera c = device_camera(camera, {1 + random() % 100, 1 + random() % 100});
    const glm::vec3 right = glm::normalize(c.right), up = glm::normalize(c.up);
    const auto at = [&](glm::vec2 ndc) {
      const glm::vec3 ray = c.forward + (ndc.x + c.shift.x) * c.right + (ndc.y + c.shift.y) * c.up;
      const glm::vec4 clip = c.clip_from_world * glm::vec4(c.eye_world + 5.0f * ray, 1);
      EXPECT_NEAR(clip.x / clip.w, ndc.x, 1e-4f);
      EXPECT_NEAR(clip.y / clip.w, -ndc.y, 1e-4f);
      return glm::vec2(glm::dot(ray, right), glm::dot(ray, up));
    };
    const glm::vec2 low = at({-1, -1}), high = at({1, 1});
    EXPECT_NEAR(low.x, frustum.left, 1e-5f);
    EXPECT_NEAR(low.y, frustum.down, 1e-5f);
    EXPECT_NEAR(high.x, frustum.right, 1e-5f);
    EXPECT_NEAR(high.y, frustum.up, 1e-5f);
  }
}

TEST(DeviceCamera, ASymmetricFrustumIsThatFieldOfView) {
  scene::Camera camera{{1, 2, 3}, {2, 1, 0}, 1.1f};
  const shared::Camera expected = device_camera(camera, {64, 36});
  const float up = std::tan(0.55f), right = up * 64 / 36;
  camera.frustum = {-right, right, -up, up};
  camera.vertical_fov = 0.3f;
  const shared::Camera made = device_camera(camera, {64, 36});
  EXPECT_LT(glm::length(made.right - expected.right), 1e-6f);
  EXPECT_LT(glm::length(made.up - expected.up), 1e-6f);
  EXPECT_LT(glm::length(made.shift), 1e-6f);
}

// Also nearly straight down, where a player's pitch ends.
TEST(DeviceCamera, HasNoRoll) {
  for (const double pitch : {0.0, 45.0, 80.0, 88.0, 89.0, 89.9, -89.9}) {
    const double angle = glm::radians(pitch);
    const glm::vec3 forward(0, -std::sin(angle), -std::cos(angle));
    const shared::Camera c = device_camera({glm::vec3(0), forward, 1}, {16, 9});
    EXPECT_GT(glm::normalize(c.right).x, 0.9999f) << pitch;
    EXPECT_GE(c.up.y, 0) << pitch;
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
