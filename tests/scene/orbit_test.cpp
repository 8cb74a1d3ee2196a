// A camera that circles what it shows.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <vector>

#include "scene/scene.hpp"

namespace brume::scene {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// Where a point is in the image: -1 to 1 from edge to edge; beyond for points outside.
glm::dvec2 projected(const Camera& camera, glm::dvec3 p, double aspect) {
  const glm::dmat4 view =
      glm::lookAt(glm::dvec3(camera.position_world), glm::dvec3(camera.target_world), glm::dvec3(0, 1, 0));
  const glm::dvec4 q = view * glm::dvec4(p, 1);
  const double vertical = std::tan(double{camera.vertical_fov} / 2);
  return {q.x / (-q.z * vertical * aspect), q.y / (-q.z * vertical)};
}

std::vector<glm::vec3> corners_of(const Box<float>& box) {
  std::vector<glm::vec3> corners;
  for (int corner = 0; corner < 8; ++corner)
    corners.push_back(glm::mix(box.low, box.high, glm::bvec3(corner & 1, corner & 2, corner & 4)));
  return corners;
}

/// The distance of the farthest corner of a box from the middle of the image, over an orbit: 1 is the edge.
double farthest_on_orbit(const Camera& camera, const Box<float>& box, glm::vec3 centre, double radians,
                         double aspect) {
  constexpr int kSteps = 3600;
  double farthest = 0;
  for (int step = 0; step <= kSteps; ++step) {
    const Camera turned = orbited(camera, centre, radians * step / kSteps);
    for (const glm::vec3 corner : corners_of(box)) {
      const glm::dvec2 at = glm::abs(projected(turned, glm::dvec3(corner), aspect));
      farthest = std::max({farthest, at.x, at.y});
    }
  }
  return farthest;
}

Scene scene_of(const Box<float>& box) {
  Scene scene;
  scene.volumes.push_back({"cloud", box, box});
  return scene;
}

TEST(Orbit, CirclesItsCentreAtTheSameHeightAndDistance) {
  const Camera camera{{3, 4.5f, -2}, {0.5f, 1, 0.25f}, 0.9f};
  const glm::vec3 centre{0.2f, 1.5f, -0.4f};
  // Of float32 coordinates below 8.
  constexpr double kNear = 4 * 0x1p-21;
  const glm::dvec3 off = glm::dvec3(camera.position_world - centre);
  const double reach = std::hypot(off.x, off.z), azimuth = std::atan2(off.x, off.z);
  for (const double turn : {kTurn, -kTurn, 0.25 * kTurn, 3 * kTurn})
    for (int k = 0; k < 7; ++k) {
      const double angle = turn * k / 7;
      const Camera turned = orbited(camera, centre, angle);
      const glm::dvec3 expected(double{centre.x} + reach * std::sin(azimuth + angle), camera.position_world.y,
                                double{centre.z} + reach * std::cos(azimuth + angle));
      EXPECT_LT(glm::length(glm::dvec3(turned.position_world) - expected), kNear) << angle;
      EXPECT_EQ(turned.position_world.y, camera.position_world.y);
      EXPECT_EQ(turned.target_world.y, camera.target_world.y);
      EXPECT_EQ(turned.vertical_fov, camera.vertical_fov);
      // The same pixel: a bound of a 400,000th of the image.
      EXPECT_LT(glm::length(projected(turned, glm::dvec3(centre), 1.5) -
                            projected(camera, glm::dvec3(centre), 1.5)),
                5e-6);
    }
}

TEST(Orbit, AnAngleOfZeroChangesNothing) {
  const Camera camera{{3, 4.5f, -2}, {0.5f, 1, 0.25f}, 0.9f}, same = orbited(camera, {1, 2, 3}, 0);
  EXPECT_EQ(same.position_world, camera.position_world);
  EXPECT_EQ(same.target_world, camera.target_world);
}

TEST(Orbit, TurnsCounterClockwiseAsSeenFromAbove) {
  const Camera turned = orbited({{0, 1, 2}, {0, 0, 0}, 1}, {0, 0, 0}, kTurn / 4);
  EXPECT_LT(glm::length(turned.position_world - glm::vec3(2, 1, 0)), 1e-6f);
}

TEST(Orbit, ACameraThatFramesACubeStays) {
  const Box<float> box{{-1, 2, 5}, {1, 4, 7}};
  for (const float aspect : {0.5f, 1.0f, 16.0f / 9.0f}) {
    const Camera camera = default_camera(scene_of(box), aspect);
    EXPECT_EQ(fitted_to_orbit(corners_of(box), camera, {0, 3, 6}, kTurn, aspect).position_world,
              camera.position_world);
  }
}

// Nothing leaves the image, and no more room is left than required.
TEST(Orbit, FramesLongBoxesAtEveryAngle) {
  const std::array boxes{Box<float>{{-8, 0, -0.5f}, {8, 1, 0.5f}}, Box<float>{{2, -3, -7}, {3, -2.5f, 5}},
                         Box<float>{{-3, 0, -3}, {3, 0.2f, 3}}};
  int moved = 0;
  for (const Box<float>& box : boxes)
    for (const float aspect : {0.5f, 16.0f / 9.0f})
      for (const double radians : {kTurn, -0.3 * kTurn, 0.2, -2.5 * kTurn}) {
        const glm::vec3 centre = 0.5f * (box.low + box.high);
        const Camera camera = default_camera(scene_of(box), aspect);
        const Camera fitted = fitted_to_orbit(corners_of(box), camera, centre, radians, aspect);
        const double farthest = farthest_on_orbit(fitted, box, centre, radians, double{aspect});
        // 1e-4: what fitted_to_orbit takes for equal.
        EXPECT_LT(farthest, 1.0002) << aspect << " " << radians;
        if (fitted.position_world == camera.position_world) continue;
        ++moved;
        EXPECT_GT(farthest, 0.9998) << aspect << " " << radians;
        EXPECT_GT(farthest_on_orbit(camera, box, centre, radians, double{aspect}), 1) << aspect;
        const auto direction = [](const Camera& c) {
          return glm::normalize(c.target_world - c.position_world);
        };
        EXPECT_LT(glm::length(direction(fitted) - direction(camera)), 1e-6f);
      }
  EXPECT_GT(moved, 4);
}

}  // namespace
}  // namespace brume::scene
