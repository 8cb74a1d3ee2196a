#include "planning/volume_inputs.hpp"

#include <algorithm>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>

#include "planning/glow_lights.hpp"

namespace brume::planning {
namespace {

static_assert(scene::kMostVolumes == shared::kMaxVolumes);
static_assert(scene::kMostVolumes <= shared::kMaxParticleSystems);

/// A volume that moves with its carrier.
void move_by(const glm::mat4& pose, volumes::VolumeAt& volume) {
  for (glm::mat4* matrix : {&volume.world_from_density, &volume.world_from_heat,
                            &volume.world_from_density_preview, &volume.world_from_heat_preview})
    *matrix = pose * *matrix;
}

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

/// The quads that show a volume's masks, of its box in the world.
ParticleInput particles_of(const scene::VolumeOptions& options, const scenario::SliceVolume& slices,
                           const grids::DenseVolume& volume, const glm::mat4& pose, double seconds) {
  const Box<double>& box = volume.front().box;
  const glm::dmat4 box_from_uvw =
      glm::translate(glm::dmat4(1), box.low) * glm::scale(glm::dmat4(1), box.high - box.low);
  ParticleInput input;
  input.world_from_uvw =
      pose * volumes::world_from_file(options) * slices.file_from_box * glm::mat4(box_from_uvw);
  input.slices = static_cast<std::uint32_t>(slices.volume);
  for (std::size_t mask = 0; mask < options.masks.size(); ++mask)
    input.tints[mask] = scene::glow_at(options.masks[mask], seconds);
  input.extinction = options.extinction;
  input.count = options.particles;
  input.radius = options.particle_size;
  input.time = seconds;
  // They stream along the volume as its slices do.
  constexpr float kDrift = 0.5f;
  input.drift = kDrift;
  // As deep as a tenth of the box's shortest edge.
  const glm::mat3 axes(input.world_from_uvw);
  input.softness = 0.1f * std::min({glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])});
  return input;
}

void add_glow(const scene::VolumeOptions& options, const volumes::VolumeAt& volume, double seconds,
              FrameInput& input) {
  // With indirect light, what is scattered leaves by its cells.
  const bool scattered = input.environment.bounces == 0;
  for (shared::Light light : glow_lights(options, volume, seconds, input.view.exposure, scattered)) {
    light.glow_of = static_cast<std::uint32_t>(input.volumes.size());
    input.environment.glow.push_back(light);
  }
}

}  // namespace

void add_volume(const scene::VolumeOptions& options, const volumes::VolumeAt& volume,
                const volumes::VolumeFrame& typical, double seconds, FrameInput& input) {
  input.volumes.push_back(input_of(options, volume, typical, seconds));
  add_glow(options, volume, seconds, input);
}

void sort_glow(FrameInput& input) {
  std::ranges::stable_sort(input.environment.glow, std::greater(), &shared::Light::range);
}

void add_volumes(const scenario::Scenario& scenario, std::span<const scene::Carrier> carriers, double seconds,
                 const FrameOptions& frame, FrameInput& input) {
  if (!scenario.volumes) return;
  const std::vector<scene::VolumeOptions>& options = scenario.timeline.volumes;
  std::vector<volumes::VolumeAt> volumes = scenario.volumes->at(options, seconds, frame.wait);
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    if (!volumes[i].frame) continue;
    const glm::mat4 pose = scene::pose_of(carriers, options[i].carrier, seconds);
    move_by(pose, volumes[i]);
    const auto& slices = scenario.slices.of_volumes;
    const bool is_particles =
        frame.particles && options[i].particles > 0 && i < slices.size() && slices[i].has_value();
    if (is_particles) {
      input.particles.push_back(particles_of(options[i], *slices[i],
                                             *(*scenario.slices.volumes)[slices[i]->volume], pose, seconds));
      input.particles.back().index = i;
      add_glow(options[i], volumes[i], seconds, input);
    } else {
      add_volume(options[i], volumes[i], scenario.volumes->typical_frame(i), seconds, input);
      input.volumes.back().index = i;
    }
  }
  sort_glow(input);
}

}  // namespace brume::planning
