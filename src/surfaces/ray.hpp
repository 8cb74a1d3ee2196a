// Rays through surfaces and media.
#pragma once

#include <glm/glm.hpp>
#include <limits>

namespace brume::surfaces {

struct Ray {
  static constexpr float kNoEnd = std::numeric_limits<float>::infinity();
  glm::vec3 origin{0};
  glm::vec3 direction{0, 0, 1};  ///< Unit.
  float end = kNoEnd;            ///< [m]
  float time = 0;                ///< While the shutter is open, [0, 1].
  glm::vec3 at(float t) const { return origin + t * direction; }
  Ray without_end() const { return {origin, direction, kNoEnd, time}; }
};

}  // namespace brume::surfaces
