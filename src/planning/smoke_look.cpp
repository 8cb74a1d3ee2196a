#include "planning/smoke_look.hpp"

#include "smoke/noise_tile.hpp"

namespace brume::planning {

shared::SmokeLook smoke_look(const scene::SmokeOptions& options, float voxel_size) {
  shared::SmokeLook look{};
  look.albedo = options.albedo;
  look.extinction = options.extinction;
  look.phase =
      options.droplet ? shared::phase_of_droplet(*options.droplet) : shared::phase_of_hg(options.anisotropy);
  look.step_length = 0.4f * voxel_size;
  look.opaque_transmittance = 0.004f;
  look.erosion = options.erosion;
  look.noise_frequency = 1 / (static_cast<float>(smoke::kSmokeNoise.coarse_cells) * options.noise_size);
  look.detail = options.detail;
  look.rise = options.rise;
  look.swirl = options.swirl;
  look.swirl_width = 2.0f * options.noise_size;
  look.multiple_scattering = options.multiple_scattering;
  look.hole_rim = options.hole_rim;
  return look;
}

}  // namespace brume::planning
