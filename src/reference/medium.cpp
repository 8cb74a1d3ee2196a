#include "reference/medium.hpp"

#include <optional>
#include <utility>

#include "surfaces/motion.hpp"

namespace brume::reference {

using surfaces::at_time;

void Medium::set_motion(std::vector<glm::mat4> world_from_rest) {
  world_from_rest_ = std::move(world_from_rest);
}

Ray Medium::at_rest(const Ray& ray) const {
  if (world_from_rest_.empty()) return ray;
  const glm::mat4 rest = glm::inverse(at_time<glm::mat4>(world_from_rest_, ray.time));
  return {glm::vec3(rest * glm::vec4(ray.origin, 1)), glm::mat3(rest) * ray.direction, ray.end, ray.time};
}

glm::vec3 Medium::world_from_rest(const glm::vec3& p_rest, float time) const {
  if (world_from_rest_.empty()) return p_rest;
  return glm::vec3(at_time<glm::mat4>(world_from_rest_, time) * glm::vec4(p_rest, 1));
}

float Medium::collisions(const glm::vec3& p_world) const {
  const std::optional<std::uint32_t> cell = majorants_.cell_at(p_world);
  if (!cell || !(majorants_.bound(*cell) > 0)) return 0;
  return glm::min(extinction(p_world), majorants_.bound(*cell));
}

}  // namespace brume::reference
