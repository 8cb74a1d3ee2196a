#include "render/glow_lights.hpp"

#include <algorithm>
#include <cmath>

#include "planning/blackbody.hpp"

namespace brume::render {
namespace {

/// Irradiance below which a light is not seen, at an exposure of 1.
constexpr double kLeastIrradiance = 0.003;
constexpr double kMostRange = 1e5;  // [m]
/// Beyond these, where colours no longer change and nothing is to be seen for light, floats would overflow
/// [K, W/sr].
constexpr double kMostKelvin = 1e5, kMostIntensity = 1e9;

shared::Light light_of(const scene::VolumeOptions& options, const scenario::VolumeAt& volume,
                       const grids::GlowBall& ball, double exposure) {
  const scenario::VolumeFrame& frame = *volume.frame;
  const double voxel_volume = std::abs(glm::determinant(glm::dmat3(glm::dmat4(volume.world_from_heat))));
  const double radius = ball.radius * std::cbrt(voxel_volume);
  const double kelvin = double{options.kelvin} * double{frame.heat->unit};
  const double ratio = kelvin / double{planning::kUnitGlow};

  // Radiance per metre, summed over the ball [W/sr], in the colour of its mean temperature.
  const double glow =
      double{options.extinction} * double{options.emission} * std::pow(ratio, 4) * ball.fourth;
  const double mean = std::min(kelvin * ball.value, kMostKelvin);
  const glm::dvec3 color = glm::dvec3(planning::blackbody_color(static_cast<float>(mean))) /
                           std::pow(mean / double{planning::kUnitGlow}, 4);
  const double extinction = double{options.extinction} * double{frame.density.unit} * ball.density;
  const double leaves = grids::escape_from_ball(extinction * radius);

  shared::Light light{};
  light.kind = shared::kLightPoint;
  light.position_world = glm::vec3(glm::dmat4(volume.world_from_heat) * glm::dvec4(ball.middle, 1));
  light.radius = static_cast<float>(radius);
  const glm::dvec3 intensity = color * std::min(glow * voxel_volume * leaves, kMostIntensity);
  light.intensity = glm::vec3(intensity);
  const double brightest = std::max({intensity.r, intensity.g, intensity.b});
  light.range = static_cast<float>(std::min(std::sqrt(brightest * exposure / kLeastIrradiance), kMostRange));
  light.direction = {0, -1, 0};
  light.shadow_layer = shared::kShadowByVoxels;
  return light;
}

}  // namespace

std::vector<shared::Light> glow_lights(const scene::VolumeOptions& options, const scenario::VolumeAt& volume,
                                       float exposure) {
  std::vector<shared::Light> lights;
  if (!volume.frame || !volume.frame->heat || options.emission <= 0 || options.kelvin <= 0) return lights;
  for (const grids::GlowBall& ball : volume.frame->glow) {
    const shared::Light light = light_of(options, volume, ball, double{exposure});
    if (light.range > light.radius) lights.push_back(light);
  }
  return lights;
}

}  // namespace brume::render
