#include "planning/smoke_look.hpp"

#include "shared/opaque.h"

namespace brume::planning {

shared::SmokeLook smoke_look(const scene::SmokeOptions& options, float voxel_size) {
  shared::SmokeLook look{};
  look.albedo = options.albedo;
  look.extinction = options.extinction;
  look.phase =
      options.droplet ? shared::phase_of_droplet(*options.droplet) : shared::phase_of_hg(options.anisotropy);
  look.step_length = 0.4f * voxel_size;
  look.opaque_transmittance = shared::kUsualOpaque;
  look.multiple_scattering = options.multiple_scattering;
  smoke::set_noise(look, {.erosion = options.erosion,
                          .noise_size = options.noise_size,
                          .detail = options.detail,
                          .hole_rim = options.hole_rim,
                          .swirl = options.swirl,
                          .rise = options.rise});
  return look;
}

smoke::SightLook sight_look(const scene::SmokeOptions& options, float voxel_size, bool drawn) {
  smoke::SightLook look{options.extinction, options.albedo};
  if (drawn) look.drawn = {smoke_look(options, voxel_size), double{options.swirl_period}};
  return look;
}

}  // namespace brume::planning
