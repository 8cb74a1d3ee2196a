#include "scene/daylight.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace brume::scene {
namespace {

/// Optical depth of the air above sea level for light of a wavelength [micrometres], straight down.
double depth_of_air(double wavelength) {
  const double w2 = 1 / (wavelength * wavelength);
  const double molecules = 0.008569 * w2 * w2 * (1 + 0.0113 * w2 + 0.00013 * w2 * w2);
  const double haze = 0.05 * std::pow(wavelength, -1.3);
  return molecules + haze;
}

/// Length of the way through the air, of that straight down.
double air_mass(double elevation) {
  const double degrees = std::clamp(elevation * 180 / std::numbers::pi, 0.0, 90.0);
  return 1 / (std::sin(degrees * std::numbers::pi / 180) + 0.50572 * std::pow(degrees + 6.07995, -1.6364));
}

}  // namespace

glm::vec3 sunlight_fraction(float elevation) {
  const double longer = std::max(air_mass(double{elevation}) - air_mass(double{kDaylightElevation}), 0.0);
  const auto fraction = [&](double wavelength) {
    return static_cast<float>(std::exp(-depth_of_air(wavelength) * longer));
  };
  return {fraction(0.65), fraction(0.55), fraction(0.45)};
}

float dim_sky(SkyOptions& sky, float elevation) {
  const float light = sunlight_fraction(elevation).g, low = 1 - light;
  const float brightness = glm::mix(0.2f, 1.0f, light);
  const auto warmed = [&](glm::vec3 color, glm::vec3 warm, float most) {
    const float luminance = glm::dot(color, glm::vec3(0.2126f, 0.7152f, 0.0722f));
    return brightness * glm::mix(color, luminance * warm, low * most);
  };
  sky.horizon = warmed(sky.horizon, {1.55f, 0.9f, 0.58f}, 0.85f);
  sky.zenith = warmed(sky.zenith, {1.0f, 0.9f, 1.6f}, 0.4f);
  sky.ambient = warmed(sky.ambient, {1.1f, 0.97f, 1.0f}, 0.5f);
  return brightness;
}

}  // namespace brume::scene
