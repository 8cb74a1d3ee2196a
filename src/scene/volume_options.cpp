#include "scene/volume_options.hpp"

#include <span>

#include "scene/key_path.hpp"

namespace brume::scene {

glm::vec3 glow_at(const VolumeMask& mask, double time) {
  if (mask.keys.empty()) return mask.color * mask.intensity;
  const auto [before, after] = span_at(std::span(mask.keys), time);
  const MaskKey &a = mask.keys[before], &b = mask.keys[after];
  if (before == after) return a.color * a.intensity;
  const auto part = static_cast<float>((time - a.time) / (b.time - a.time));
  return glm::mix(a.color, b.color, part) * glm::mix(a.intensity, b.intensity, part);
}

}  // namespace brume::scene
