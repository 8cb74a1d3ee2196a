#include "planning/smoke_visibility.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "shared/smoke_light.h"
#include "tests/sanitized.hpp"
#include "tests/worlds.hpp"

namespace brume::planning {
namespace {

class SmokeVisibilityTest : public ::testing::Test {
 protected:
  static constexpr int kAcross = 320, kHigh = 40;  // voxels of the world

  SmokeVisibilityTest() {
    for (int i = 0; i < 30; ++i) {
      const glm::vec3 at = inside(2);
      world_.append(smoke_at(glm::dvec3(at), 300 + static_cast<std::uint32_t>(random_() % 1500)));
    }
    world_.advance_to(90);
    for (int i = 0; i < 25; ++i) {
      shared::Light& light = lights_.emplace_back(point_light(inside(0), glm::vec3(0), 0));
      light.range = 3 + 22 * unit(random_);
      if (i % 3 == 0) light.kind = shared::kLightSpot;
    }
    lights_.push_back(sun_light({0.5f, -0.6f, 0.3f}, 0, 0));
  }

  float unit(std::mt19937& random) { return std::uniform_real_distribution<float>(0, 1)(random); }
  /// A point of the world, so far from its sides [m].
  glm::vec3 inside(float margin) {
    const glm::vec3 size = glm::vec3(kAcross, kHigh, kAcross) * kVoxel - 2 * margin;
    return glm::vec3(margin) + size * glm::vec3(unit(random_), unit(random_), unit(random_));
  }
  /// A parallel one has a picture 1 to 40 m wide.
  shared::Camera camera(bool parallel) {
    shared::Camera camera{};
    camera.eye_world = inside(0);
    const float yaw = 6.2832f * unit(random_), pitch = 1.2f * (unit(random_) - 0.5f);
    camera.forward = {std::cos(pitch) * std::cos(yaw), std::sin(pitch), std::cos(pitch) * std::sin(yaw)};
    camera.parallel = parallel ? 1.0f : 0.0f;
    const float wide = (0.05f + 0.7f * unit(random_)) * (parallel ? 27 : 1);
    camera.right = wide * glm::normalize(glm::cross(camera.forward, glm::vec3(0, 1, 0)));
    camera.up = 0.6f * wide * glm::normalize(glm::cross(camera.right, camera.forward));
    return camera;
  }
  /// Where the ray of a point of the picture begins, and where it is at a distance along the axis.
  static std::pair<glm::vec3, glm::vec3> ray_of(const shared::Camera& camera, float x, float y, float far) {
    const glm::vec3 aside = x * camera.right + y * camera.up,
                    from = camera.eye_world + camera.parallel * aside;
    return {from, from + far * (camera.forward + (1 - camera.parallel) * aside)};
  }
  SmokeVisibility visible_from(const shared::Camera& camera) const {
    const ViewFrustum view(camera);
    return cull_smoke(volume_, view, visible_lights(lights_, view, light_interpolation_margin(kVoxel)),
                      scene_);
  }
  /// Whether all smoke on a segment is required: sampled twice a voxel.
  bool all_visible(const SmokeVisibility& visibility, glm::vec3 from, glm::vec3 segment,
                   bool on_screen) const {
    const Box<float>& bounds = on_screen ? visibility.visible_bounds : visibility.caster_bounds;
    const std::size_t first_slots = on_screen ? visibility.visible_count : visibility.slots.size();
    const int count = static_cast<int>(glm::length(segment) / (0.5f * kVoxel)) + 1;
    for (int i = 0; i <= count; ++i) {
      const glm::vec3 p = (from + segment * (static_cast<float>(i) / static_cast<float>(count))) / kVoxel;
      if (smoke::sample_density(volume_, p) <= 0) continue;
      const std::uint32_t slot = volume_.slot_at(glm::ivec3(glm::floor(p)) >> 3);
      const auto end = visibility.slots.begin() + static_cast<std::ptrdiff_t>(first_slots);
      if (std::find(visibility.slots.begin(), end, slot) == end) return false;
      if (glm::any(glm::lessThan(p, bounds.low)) || glm::any(glm::greaterThan(p, bounds.high))) return false;
    }
    return true;
  }

  static constexpr float kVoxel = 0.5f;
  std::mt19937 random_{8};
  SmokeWorld world_{voxel::BitGrid({{kAcross, kHigh, kAcross}, kVoxel, glm::vec3(0)})};
  const smoke::SmokeVolume& volume_ = world_.volume;
  Box<float> scene_{glm::vec3(0), glm::vec3(kAcross, kHigh, kAcross) * kVoxel};
  std::vector<shared::Light> lights_;
};

TEST_F(SmokeVisibilityTest, ABoxAroundAPointInViewMayBeInView) {
  std::uniform_real_distribution<float> unit(-1, 1);
  const auto any = [&] { return glm::vec3(unit(random_), unit(random_), unit(random_)); };
  int hidden = 0;
  for (int i = 0; i < 20000; ++i) {
    const shared::Camera camera = this->camera(i % 3 == 0);
    const ViewFrustum view(camera);
    const float distance = 0.01f + 30 * std::abs(unit(random_)), x = unit(random_), y = unit(random_);
    const glm::vec3 point = ray_of(camera, x, y, distance).second;
    const glm::vec3 below = 3.0f * glm::abs(any()), above = 3.0f * glm::abs(any());
    EXPECT_TRUE(view.may_intersect(Box<float>{point - below, point + above})) << i;
    const glm::vec3 behind = camera.eye_world - 6.0f * camera.forward;
    hidden += !view.may_intersect(Box<float>{behind - below, behind + above});
  }
  EXPECT_GT(hidden, 10000);
}

// Every ray that the passes march for a frame finds its smoke among the required slots.
TEST_F(SmokeVisibilityTest, NoRayOfAFrameMeetsSmokeThatIsNotRequired) {
  constexpr int kFrames = kSanitized ? 400 : 4000;
  std::size_t rays = 0, fewer = 0;
  const shared::Light sun = lights_.back();
  for (int i = 0; i < kFrames; ++i) {
    // Every other time there is no sun, which requires much that lights require, too.
    lights_.resize(25);
    if (i % 2 == 0) lights_.push_back(sun);
    const shared::Camera camera = this->camera(i % 5 == 4);
    const SmokeVisibility visibility = visible_from(camera);
    fewer += visibility.slots.size() < all_smoke_visible(volume_).slots.size();
    for (int k = 0; k < 40; ++k) {
      // A point in view; smoke may be between it and the eye.
      const float x = 2 * unit(random_) - 1, y = 2 * unit(random_) - 1, far = 60 * unit(random_);
      const auto [from, p] = ray_of(camera, x, y, far);
      EXPECT_TRUE(all_visible(visibility, from, p - from, true));
      if (glm::any(glm::lessThan(p, scene_.low)) || glm::any(glm::greaterThan(p, scene_.high))) continue;
      // It is lit.
      for (const shared::Light& light : lights_) {
        glm::vec3 segment = light.position_world - p;
        if (light.kind == shared::kLightDirectional)
          segment = -200.0f * light.direction;
        else if (glm::length(segment) >= light.range)
          continue;
        EXPECT_TRUE(all_visible(visibility, p, segment, false));
        ++rays;
      }
      if (smoke::sample_density(volume_, p / kVoxel) <= 0) continue;
      for (std::uint32_t sky = 0; sky < shared::kSkyRays; ++sky, ++rays)
        EXPECT_TRUE(all_visible(visibility, p, 200.0f * shared::sky_ray(sky), false));
    }
  }
  EXPECT_GT(rays, 5000u);
  EXPECT_GT(fewer, kFrames * 3u / 4) << "most frames require less than all";
}

TEST_F(SmokeVisibilityTest, SmokeFarBehindIsNotRequired) {
  lights_.pop_back();  // the sun
  shared::Camera camera{};
  camera.eye_world = {-100, 10, 80};
  camera.forward = {-1, 0, 0};
  camera.right = {0, 0, 0.7f};
  camera.up = {0, 0.4f, 0};
  const SmokeVisibility none = visible_from(camera);
  EXPECT_TRUE(none.slots.empty());
  EXPECT_EQ(none.caster_bounds.low, none.caster_bounds.high);
  EXPECT_TRUE(smoke_boxes(volume_, none).empty());
  camera.forward = {1, 0, 0};
  EXPECT_GT(visible_from(camera).visible_count, 0u);
}

// Of all smoke the boxes are what bounds it.
TEST_F(SmokeVisibilityTest, BoxesHoldTheRequiredSmoke) {
  const SmokeVisibility all = all_smoke_visible(volume_);
  const auto boxes = smoke_boxes(volume_, all);
  for (int i = 0; i < 20000; ++i) {
    const glm::vec3 p = inside(0);
    if (smoke::sample_density(volume_, p / kVoxel) <= 0) continue;
    EXPECT_TRUE(std::any_of(boxes.begin(), boxes.end(), [&](const Box<float>& box) {
      return glm::all(glm::lessThanEqual(box.low, p)) && glm::all(glm::lessThanEqual(p, box.high));
    }));
  }
}

}  // namespace
}  // namespace brume::planning
