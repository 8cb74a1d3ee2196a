#include "scene/carrier.hpp"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/key_path.hpp"

namespace brume::scene {

glm::mat4 rotation_of(const glm::vec3& degrees) {
  glm::mat4 matrix(1);
  for (const int axis : {2, 1, 0}) {
    glm::vec3 around(0);
    around[axis] = 1;
    matrix = glm::rotate(matrix, glm::radians(degrees[axis]), around);
  }
  return matrix;
}

CarrierKey key_at(const Carrier& carrier, double time) {
  const std::span keys(carrier.keys);
  return {time, smooth_at(keys, time, [](const CarrierKey& key) { return key.position_world; }),
          smooth_at(keys, time, [](const CarrierKey& key) { return key.rotation; })};
}

glm::mat4 pose_at(const Carrier& carrier, double time) {
  const CarrierKey key = key_at(carrier, time);
  return glm::translate(glm::mat4(1), key.position_world) * rotation_of(key.rotation);
}

glm::mat4 pose_of(std::span<const Carrier> carriers, const std::string& name, double time) {
  const auto found = std::ranges::find(carriers, name, &Carrier::name);
  return found == carriers.end() ? glm::mat4(1) : pose_at(*found, time);
}

}  // namespace brume::scene
