#include "planning/exposure.hpp"

#include <algorithm>
#include <cmath>

namespace brume::planning {

float exposure_of(std::span<const glm::vec4> radiance) {
  constexpr double kMiddle = 0.28, kStrength = 0.85;
  double sum = 0;
  for (const glm::vec4& pixel : radiance)
    sum += std::log(std::max(glm::dot(glm::dvec3(pixel), glm::dvec3(0.2126, 0.7152, 0.0722)), 1e-5));
  const double mean = std::exp(sum / static_cast<double>(radiance.size()));
  return static_cast<float>(std::pow(kMiddle / mean, kStrength));
}

}  // namespace brume::planning
