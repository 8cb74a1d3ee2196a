#include "spheres/color.hpp"

#include <array>
#include <cmath>

namespace brume::spheres {
namespace {

struct Tables {
  std::array<double, 256> extinction{};
  std::array<float, 256> linear{};

  Tables() {
    for (std::size_t i = 0; i < 256; ++i) {
      const double part = static_cast<double>(i) / 255;
      extinction[i] = -std::log1p(-part);
      linear[i] = static_cast<float>(part <= 0.04045 ? part / 12.92 : std::pow((part + 0.055) / 1.055, 2.4));
    }
  }
};

const Tables& color_tables() {
  static const Tables tables;
  return tables;
}

}  // namespace

double extinction_of(Color color) {
  return color_tables().extinction[color >> 24];
}

glm::vec3 albedo_of(Color color) {
  const std::array<float, 256>& linear = color_tables().linear;
  return {linear[color & 255], linear[color >> 8 & 255], linear[color >> 16 & 255]};
}

}  // namespace brume::spheres
