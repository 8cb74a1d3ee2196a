#include "apps/viewer/tank_camera.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "planning/device_camera.hpp"
#include "spheres/trace.hpp"

namespace brume::viewer {
namespace {

/// Largest elevation of the camera above the horizon [rad]: straight above, its right would be undefined.
constexpr float kSteepest = 1.55f;
/// Half a turn for a drag across the picture's height.
constexpr float kTurn = std::numbers::pi_v<float>;
/// Factor of the distance to the target, for each notch of the wheel.
constexpr float kZoom = 0.9f;
/// Least distance to the target [m]: the camera does not pass it.
constexpr float kNearest = 0.01f;

struct Axes {
  glm::vec3 right, up, forward;
};

Axes axes_of(const scene::Camera& camera) {
  const shared::Camera device = planning::device_camera(camera, glm::uvec2(1));
  const glm::vec3 forward = glm::normalize(camera.target_world - camera.position_world);
  const glm::vec3 right = glm::normalize(device.right);
  return {right, glm::cross(right, forward), forward};
}

/// The picture's height at a distance of 1.
float height_at_one(const scene::Camera& camera) {
  return 2 * std::tan(0.5f * camera.vertical_fov);
}

}  // namespace

scene::Camera orbited(const scene::Camera& camera, glm::vec2 drag) {
  const glm::vec3 arm = camera.position_world - camera.target_world;
  const float distance = glm::length(arm);
  const float azimuth = std::atan2(arm.x, arm.z) - kTurn * drag.x;
  const float elevation = std::clamp(std::asin(std::clamp(arm.y / distance, -1.0f, 1.0f)) + kTurn * drag.y,
                                     -kSteepest, kSteepest);
  scene::Camera moved = camera;
  moved.position_world =
      camera.target_world + distance * glm::vec3(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                                                 std::cos(elevation) * std::cos(azimuth));
  return moved;
}

scene::Camera panned(const scene::Camera& camera, glm::vec2 drag) {
  const glm::vec3 step = dragged(camera, drag, camera.target_world) - camera.target_world;
  scene::Camera moved = camera;
  moved.position_world -= step;
  moved.target_world -= step;
  return moved;
}

scene::Camera zoomed(const scene::Camera& camera, double notches) {
  const glm::vec3 arm = camera.position_world - camera.target_world;
  const float distance = glm::length(arm);
  const float nearer = std::max(distance * std::pow(kZoom, static_cast<float>(notches)), kNearest);
  scene::Camera moved = camera;
  moved.position_world = camera.target_world + arm * (nearer / distance);
  return moved;
}

scene::Camera glided(const scene::Camera& camera, const glm::vec3& steps) {
  const Axes axes = axes_of(camera);
  const glm::vec3 step = steps.x * axes.right + steps.y * glm::vec3(0, 1, 0) + steps.z * axes.forward;
  scene::Camera moved = camera;
  moved.position_world += step;
  moved.target_world += step;
  return moved;
}

std::optional<glm::vec2> in_picture(const scene::Camera& camera, glm::vec2 size, const glm::vec3& world) {
  const auto device = planning::device_camera(camera, glm::uvec2(glm::max(size, glm::vec2(1))));
  const glm::vec4 clip = device.clip_from_world * glm::vec4(world, 1);
  if (clip.w < planning::kNearPlane) return std::nullopt;
  return (0.5f + 0.5f * glm::vec2(clip) / clip.w) * size;
}

glm::vec3 dragged(const scene::Camera& camera, glm::vec2 drag, const glm::vec3& world) {
  const Axes axes = axes_of(camera);
  const float height = depth_of(camera, world) * height_at_one(camera);
  return world + height * (drag.x * axes.right - drag.y * axes.up);
}

float depth_of(const scene::Camera& camera, const glm::vec3& world) {
  const glm::vec3 forward = glm::normalize(camera.target_world - camera.position_world);
  return std::max(glm::dot(world - camera.position_world, forward), planning::kNearPlane);
}

float distance_ahead(const scene::Camera& camera, const spheres::Tank& tank) {
  const glm::dvec3 eye = glm::dvec3(camera.position_world) / double{tank.voxel} + 0.5 * glm::dvec3(tank.size);
  const glm::dvec3 forward =
      glm::normalize(glm::dvec3(camera.target_world) - glm::dvec3(camera.position_world));
  std::optional<double> nearest;
  for (const spheres::Sphere& sphere : tank.spheres)
    if (const auto chord = spheres::chord_of(sphere, eye, forward); chord && chord->x > 0)
      nearest = std::min(nearest.value_or(chord->x), chord->x);
  if (!nearest) return depth_of(camera, glm::vec3(0));
  return std::max(static_cast<float>(*nearest * double{tank.voxel}), planning::kNearPlane);
}

}  // namespace brume::viewer
