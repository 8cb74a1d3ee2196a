// The guarantees of the scene readers for any scene that they accept.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>

#include "scene/scene.hpp"

namespace brume::scene {

inline void check_scene(const Scene& scene) {
  for (const Mesh& mesh : scene.meshes) {
    if (mesh.indices.size() % 3 != 0) __builtin_trap();
    for (const std::uint32_t index : mesh.indices) {
      if (index >= mesh.vertices.size()) __builtin_trap();
    }
    for (const Vertex& vertex : mesh.vertices) {
      const float length = glm::length(vertex.normal), tangent = glm::length(glm::vec3(vertex.tangent));
      if (!(std::abs(length - 1) < 1e-3f) || !(std::abs(tangent - 1) < 1e-3f)) __builtin_trap();
      if (!std::isfinite(vertex.uv.x) || !std::isfinite(vertex.uv.y)) __builtin_trap();
    }
  }
  for (const Object& object : scene.objects) {
    if (object.mesh >= scene.meshes.size() || object.material >= scene.materials.size()) __builtin_trap();
  }
  if (scene.grenade && scene.grenade->mesh >= scene.meshes.size()) __builtin_trap();
  if (scene.grenade && scene.grenade->material >= scene.materials.size()) __builtin_trap();
  const Box<float> bounds = world_bounds(scene);
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(bounds.low[axis]) || !std::isfinite(bounds.high[axis])) __builtin_trap();
  }
  for (const Light& light : scene.lights) {
    if (!std::isfinite(light.intensity.r) || !(light.intensity.r >= 0)) __builtin_trap();
    if (!(std::abs(glm::length(light.direction_world) - 1) < 1e-3f)) __builtin_trap();
  }
  const Camera camera = default_camera(scene);
  if (!(camera.vertical_fov > 0) || !std::isfinite(camera.position_world.x)) __builtin_trap();
}

inline std::string_view as_text(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace brume::scene
