#include "scene/moved_objects.hpp"

#include <algorithm>

namespace brume::scene {
namespace {

/// Place and rotation, without a scale.
glm::mat4 rigid_part(const glm::mat4& matrix) {
  glm::mat4 rigid = matrix;
  for (int axis = 0; axis < 3; ++axis)
    if (const float length = glm::length(glm::vec3(matrix[axis])); length > 0) rigid[axis] /= length;
  return rigid;
}

}  // namespace

std::vector<MovedObject> moved_objects(std::span<const Carrier> carriers, const Scene& scene,
                                       double seconds) {
  std::vector<MovedObject> moved;
  for (const Carrier& carrier : carriers) {
    if (carrier.object.empty()) continue;
    const auto first = std::ranges::find(scene.objects, carrier.object, &Object::name);
    if (first == scene.objects.end()) continue;
    const glm::mat4 from_rest = pose_at(carrier, seconds) * glm::inverse(rigid_part(first->world_from_mesh));
    for (std::size_t i = 0; i < scene.objects.size(); ++i)
      if (scene.objects[i].name == carrier.object)
        moved.push_back({static_cast<std::uint32_t>(i), from_rest * scene.objects[i].world_from_mesh});
  }
  std::ranges::sort(moved, {}, &MovedObject::object);
  return moved;
}

void exclude_moved_objects(std::span<const Carrier> carriers, Scene& scene) {
  for (const MovedObject& moved : moved_objects(carriers, scene, 0))
    scene.objects[moved.object].role = Role::ghost;
}

}  // namespace brume::scene
