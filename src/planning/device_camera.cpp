#include "planning/device_camera.hpp"

#include <cmath>

namespace brume::planning {

shared::Camera device_camera(const scene::Camera& camera, glm::uvec2 size_px) {
  // Axes of the view: forward, right, up.
  const glm::vec3 apart = camera.target_world - camera.position_world;
  const glm::vec3 forward = glm::length(apart) > 1e-6f ? glm::normalize(apart) : glm::vec3(0, 0, -1);
  const glm::vec3 helper = std::abs(forward.y) > 0.999f ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0);
  const glm::vec3 right = glm::normalize(glm::cross(forward, helper)), up = glm::cross(right, forward);
  const float tan_y = std::tan(0.5f * camera.vertical_fov);
  const float tan_x = tan_y * static_cast<float>(size_px.x) / static_cast<float>(size_px.y);

  // Reverse depth, infinite far plane; Vulkan's y runs down.
  const glm::vec3 p = camera.position_world;
  glm::mat4 rows(0);
  rows[0] = glm::vec4(right, -glm::dot(right, p)) / tan_x;
  rows[1] = glm::vec4(-up, glm::dot(up, p)) / tan_y;
  rows[2] = glm::vec4(0, 0, 0, kNearPlane);
  rows[3] = glm::vec4(forward, -glm::dot(forward, p));
  return {glm::transpose(rows), p, kNearPlane, forward, tan_x * right, tan_y * up};
}

}  // namespace brume::planning
