#include "planning/light_reach.hpp"

#include <algorithm>
#include <cmath>

namespace brume::planning {

float brightest(const shared::Light& light) {
  return std::max({light.intensity.r, light.intensity.g, light.intensity.b});
}

bool reaches(const shared::Light& light, glm::vec3 centre, float radius) {
  if (brightest(light) <= 0) return false;
  if (light.kind == shared::kLightDirectional) return true;
  const glm::vec3 to_centre = centre - light.position_world;
  const float far = light.range + radius, d2 = glm::dot(to_centre, to_centre);
  if (d2 >= far * far) return false;
  if (light.kind == shared::kLightPoint || light.cos_outer <= 0) return true;
  const float along = glm::dot(to_centre, light.direction),
              aside = std::sqrt(std::max(d2 - along * along, 0.0f));
  const float sin_outer = std::sqrt(1 - light.cos_outer * light.cos_outer);
  return light.cos_outer * aside - sin_outer * along <= 1.001f * radius && along >= -1.001f * radius;
}

float distance2(glm::vec3 a, glm::vec3 to_a, glm::vec3 b, glm::vec3 to_b) {
  const glm::vec3 along_a = to_a - a, along_b = to_b - b, apart = a - b;
  const float aa = glm::dot(along_a, along_a), bb = glm::dot(along_b, along_b);
  const float ab = glm::dot(along_a, along_b), at_a = glm::dot(along_a, apart),
              at_b = glm::dot(along_b, apart);
  const float slanted = aa * bb - ab * ab;
  float s = slanted > 1e-6f * aa * bb ? std::clamp((ab * at_b - at_a * bb) / slanted, 0.0f, 1.0f) : 0.0f;
  const float t = bb > 0 ? std::clamp((ab * s + at_b) / bb, 0.0f, 1.0f) : 0.0f;
  s = aa > 0 ? std::clamp((ab * t - at_a) / aa, 0.0f, 1.0f) : 0.0f;
  const glm::vec3 between = apart + s * along_a - t * along_b;
  return glm::dot(between, between);
}

bool intersects_box(glm::vec3 from, glm::vec3 to, glm::vec3 low, glm::vec3 high) {
  float begin = 0, end = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const float along = to[axis] - from[axis];
    if (std::abs(along) < 1e-6f) {
      if (from[axis] < low[axis] || from[axis] > high[axis]) return false;
      continue;
    }
    const float a = (low[axis] - from[axis]) / along, b = (high[axis] - from[axis]) / along;
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  return begin <= end;
}

}  // namespace brume::planning
