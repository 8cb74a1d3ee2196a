#include "scenario/frame_volumes.hpp"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "planning/volume_inputs.hpp"

namespace brume::scenario {
namespace {

static_assert(scene::kMostVolumes <= shared::kMaxParticleSystems);

/// A volume that moves with its carrier.
void move_by(const glm::mat4& pose, volumes::VolumeAt& volume) {
  for (glm::mat4* matrix : {&volume.world_from_density, &volume.world_from_heat,
                            &volume.world_from_density_preview, &volume.world_from_heat_preview})
    *matrix = pose * *matrix;
}

/// The quads that show a volume's masks, of its box in the world.
planning::ParticleInput particles_of(const scene::VolumeOptions& options, const SliceVolume& slices,
                                     const grids::DenseVolume& volume, const glm::mat4& pose,
                                     double seconds) {
  const Box<double>& box = volume.front().box;
  const glm::dmat4 box_from_uvw =
      glm::translate(glm::dmat4(1), box.low) * glm::scale(glm::dmat4(1), box.high - box.low);
  planning::ParticleInput input;
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

}  // namespace

void add_volumes(const Scenario& scenario, std::span<const scene::Carrier> carriers, double seconds,
                 const FrameOptions& frame, planning::FrameInput& input) {
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
      planning::add_glow(options[i], volumes[i], seconds, input);
    } else {
      planning::add_volume(options[i], volumes[i], scenario.volumes->typical_frame(i), seconds, input);
      input.volumes.back().index = i;
    }
  }
  planning::sort_glow(input);
}

}  // namespace brume::scenario
