#include "planning/exposure.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace brume::planning {

float exposure_of(std::span<const glm::vec4> radiance) {
  // 0.355 is 60 % of white after the neutral tone curve, in the code values of sRGB.
  constexpr double kMiddle = 0.28, kGround = 0.355, kBright = 0.65, kRange = 1e-4, kLeast = 1e-30;
  std::vector<double> luminances;
  for (const glm::vec4& pixel : radiance)
    luminances.push_back(std::max(glm::dot(glm::dvec3(pixel), glm::dvec3(0.2126, 0.7152, 0.0722)), kLeast));
  const auto at = [&](std::size_t index) {
    const auto place = luminances.begin() + static_cast<std::ptrdiff_t>(index);
    std::nth_element(luminances.begin(), place, luminances.end());
    return *place;
  };
  const double most = at(luminances.size() * 3 / 4), third = at(luminances.size() * 2 / 3);
  // What is darker than a ten-thousandth of the bright counts as that: black is black at any exposure.
  double sum = 0;
  for (const double luminance : luminances) sum += std::log(std::max(luminance, kRange * most));
  const double mean = std::exp(sum / static_cast<double>(luminances.size()));
  return static_cast<float>(
      std::clamp(std::min({kMiddle / mean, kGround / third, kBright / most}), 1e-20, 1e20));
}

}  // namespace brume::planning
