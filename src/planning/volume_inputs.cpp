#include "planning/volume_inputs.hpp"

#include <algorithm>
#include <functional>

#include "planning/glow_lights.hpp"

namespace brume::planning {
namespace {

static_assert(scene::kMostVolumes == shared::kMaxVolumes);

/// The disturbance in voxels of the density.
DisturbanceInput disturbance_of(const scene::Disturbance& disturbance, const volumes::VolumeFrame& frame,
                                double seconds) {
  if (disturbance.strength <= 0) return {};
  return {glm::mat4(glm::inverse(frame.density.world_from_voxel)), disturbance, static_cast<float>(seconds)};
}

/// The largest factor of the extinction: a value, or an opacity.
float largest_factor(const scene::VolumeOptions& options, float value) {
  if (options.opacity.empty()) return value;
  return std::ranges::max_element(options.opacity, {}, &scene::OpacityPoint::opacity)->opacity;
}

/// The optical depth along the shortest edge of a voxel, of one as dense as voxels usually are. Of the
/// typical frame, so that a sequence is lit in one way.
float voxel_depth_of(const scene::VolumeOptions& options, const glm::mat4& world_from_voxel,
                     const volumes::VolumeFrame& typical) {
  float edge = glm::length(glm::vec3(world_from_voxel[0]));
  for (int axis = 1; axis < 3; ++axis) edge = std::min(edge, glm::length(glm::vec3(world_from_voxel[axis])));
  return options.extinction * largest_factor(options, typical.density.usual) * edge;
}

VolumeInput input_of(const scene::VolumeOptions& options, const volumes::VolumeAt& volume,
                     const volumes::VolumeFrame& typical, double seconds) {
  const grids::BrickVolume& density = volume.frame->density;
  VolumeInput input;
  input.volume = density.volume.get();
  input.world_from_voxel = volume.world_from_density;
  input.colors = volume.frame->colors.get();
  input.transfer = {options.opacity, options.color_map,
                    (volumes::range_of(options, typical) - density.offset) / density.unit, options.glow,
                    options.emission};
  // Values are stored in a unit, which an opacity curve cancels.
  const float unit = options.opacity.empty() ? density.unit : 1;
  input.look = {options.albedo, options.extinction * unit, glm::vec3(0), options.anisotropy,
                options.multiple_scattering};
  input.voxel_depth = voxel_depth_of(options, volume.world_from_density, typical);
  if (const auto& heat = volume.frame->heat; heat && options.emission > 0)
    // What glows is a multiple of the look's extinction.
    input.heat = {heat->volume.get(), volume.world_from_heat,
                  volumes::kelvin_of(options, *volume.frame) * heat->unit, heat->high / heat->unit,
                  options.emission / unit};
  if (const auto& preview = volume.preview; preview && preview->density) {
    input.preview = preview->density->volume.get();
    input.world_from_preview = volume.world_from_density_preview;
  }
  if (const auto& preview = volume.preview; preview && preview->heat && input.heat.volume) {
    input.heat.preview = preview->heat->volume.get();
    input.heat.world_from_preview = volume.world_from_heat_preview;
  }
  for (const scene::VolumeMask& mask : options.masks) input.tints.push_back(scene::glow_at(mask, seconds));
  input.disturbance = disturbance_of(options.disturbance, *volume.frame, seconds);
  if (const float densest = largest_factor(options, typical.density.high);
      options.detail.strength > 0 && densest > 0)
    input.detail = {glm::mat4(glm::inverse(volume.frame->density.world_from_voxel)), options.detail,
                    densest / unit, static_cast<float>(seconds)};
  return input;
}

}  // namespace

void add_glow(const scene::VolumeOptions& options, const volumes::VolumeAt& volume, double seconds,
              FrameInput& input) {
  // With indirect light, what is scattered leaves by its cells.
  const bool scattered = input.environment.bounces == 0;
  for (shared::Light light : glow_lights(options, volume, seconds, input.view.exposure, scattered)) {
    light.glow_of = static_cast<std::uint32_t>(input.volumes.size());
    input.environment.glow.push_back(light);
  }
}

void add_volume(const scene::VolumeOptions& options, const volumes::VolumeAt& volume,
                const volumes::VolumeFrame& typical, double seconds, FrameInput& input) {
  input.volumes.push_back(input_of(options, volume, typical, seconds));
  add_glow(options, volume, seconds, input);
}

void sort_glow(FrameInput& input) {
  std::ranges::stable_sort(input.environment.glow, std::greater(), &shared::Light::range);
}

}  // namespace brume::planning
