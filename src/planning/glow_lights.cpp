#include "planning/glow_lights.hpp"

#include <algorithm>
#include <cmath>

#include "planning/blackbody.hpp"

namespace brume::planning {
namespace {

/// Irradiance below which a light is not seen, at an exposure of 1.
constexpr double kLeastIrradiance = 0.003;
constexpr double kMostRange = 1e5;  // [m]
/// Beyond these, where colours no longer change and nothing is to be seen for light, floats would overflow
/// [K, W/sr].
constexpr double kMostKelvin = 1e5, kMostIntensity = 1e9;

/// The light of a ball. `radius` [m], radiant `intensity` [W/sr].
shared::Light light_at_ball(const glm::vec3& middle_world, double radius, const glm::dvec3& intensity,
                            double exposure) {
  shared::Light light{};
  light.kind = shared::kLightPoint;
  light.position_world = middle_world;
  light.radius = static_cast<float>(radius);
  light.intensity = glm::vec3(glm::min(intensity, kMostIntensity));
  const double brightest = std::max({intensity.r, intensity.g, intensity.b});
  light.range = static_cast<float>(std::min(std::sqrt(brightest * exposure / kLeastIrradiance), kMostRange));
  light.direction = {0, -1, 0};
  light.shadow_layer = shared::kShadowByVoxels;
  return light;
}

/// The fraction of what a homogeneous ball emits that leaves it, by its optical radius. What it scatters has
/// the same chances again (Case, de Hoffmann and Placzek 1953, 8.3).
glm::dvec3 leaving_ball(const scene::VolumeOptions& options, double optical_radius, bool scattered) {
  const double escape = grids::escape_from_ball(optical_radius);
  if (!scattered) return glm::dvec3(escape);
  const glm::dvec3 albedo = glm::dvec3(options.albedo) * double{options.multiple_scattering};
  return escape / (1.0 - albedo * (1 - escape));
}

shared::Light light_of(const scene::VolumeOptions& options, const volumes::VolumeAt& volume,
                       const grids::GlowBall& ball, double exposure, bool scattered) {
  const volumes::VolumeFrame& frame = *volume.frame;
  const double voxel_volume = std::abs(glm::determinant(glm::dmat3(glm::dmat4(volume.world_from_heat))));
  const double radius = ball.radius * std::cbrt(voxel_volume);
  const double kelvin = double{volumes::kelvin_of(options, frame)} * double{frame.heat->unit};
  const double ratio = kelvin / double{kUnitGlow};

  // Radiance per metre, summed over the ball [W/sr], in the colour of its mean temperature.
  const double glow = double{options.extinction} * double{options.emission} * std::pow(ratio, 4) * ball.power;
  const double mean = std::min(kelvin * ball.value, kMostKelvin);
  const glm::dvec3 color =
      glm::dvec3(blackbody_color(static_cast<float>(mean))) / std::pow(mean / double{kUnitGlow}, 4);
  const double extinction = double{options.extinction} * double{frame.density.unit} * ball.density;
  const glm::dvec3 leaves = leaving_ball(options, extinction * radius, scattered);

  const glm::vec3 middle(glm::dmat4(volume.world_from_heat) * glm::dvec4(ball.middle, 1));
  return light_at_ball(middle, radius, color * leaves * std::min(glow * voxel_volume, kMostIntensity),
                       exposure);
}

/// What leaves a ball of a mask; the volume dims it with the extinction that it has where all masks are 1.
void add_mask_lights(const scene::VolumeOptions& options, const volumes::VolumeAt& volume, double seconds,
                     double exposure, bool scattered, std::vector<shared::Light>& lights) {
  const volumes::VolumeFrame& frame = *volume.frame;
  const glm::dmat4 world_from_file =
      glm::dmat4(volume.world_from_density) * glm::inverse(frame.density.world_from_voxel);
  const double cubed = std::abs(glm::determinant(glm::dmat3(world_from_file))), scale = std::cbrt(cubed);
  for (const volumes::MaskGlow& ball : frame.mask_glow) {
    const glm::dvec3 glow(scene::glow_at(options.masks[ball.mask], seconds));
    const double radius = ball.radius * scale;
    const glm::dvec3 leaves = leaving_ball(options, double{options.extinction} * radius, scattered);
    const glm::vec3 middle(world_from_file * glm::dvec4(ball.middle, 1));
    lights.push_back(light_at_ball(middle, radius, glow * leaves * (ball.integral * cubed), exposure));
  }
}

}  // namespace

std::vector<shared::Light> glow_lights(const scene::VolumeOptions& options, const volumes::VolumeAt& volume,
                                       double seconds, float exposure, bool scattered) {
  std::vector<shared::Light> lights;
  if (!volume.frame) return lights;
  if (volume.frame->heat && options.emission > 0 && options.kelvin > 0)
    for (const grids::GlowBall& ball : volume.frame->glow)
      lights.push_back(light_of(options, volume, ball, double{exposure}, scattered));
  add_mask_lights(options, volume, seconds, double{exposure}, scattered, lights);
  std::erase_if(lights, [](const shared::Light& light) { return !(light.range > light.radius); });
  return lights;
}

}  // namespace brume::planning
