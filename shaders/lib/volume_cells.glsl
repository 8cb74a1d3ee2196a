// The volumes besides the smoke in the cells of indirect light. The includer defines the constant kMedia.
#ifndef VOLUME_CELLS_GLSL
#define VOLUME_CELLS_GLSL
#include "lib/indirect_cells.glsl"
#include "lib/volume_transfer.glsl"

/// As media_in_cell: the mean of 4^3 points.
vec4 volumes_in_cell(ivec3 cell) {
  vec4 sum = vec4(0.0);
  for (uint v = 0u; v < frame.media.caster_count; ++v) {
    const VolumeLook look = volumes[v].look;
    for (int i = 0; i < 64; ++i) {
      const vec3 at = (vec3(cell) + (vec3(i & 3, i >> 2 & 3, i >> 4) + 0.5) / 4.0) * frame.indirect.cell_size;
      const vec3 p = matrix_of(volumes[v].voxel_from_world) * vec4(frame.indirect.origin_world + at, 1.0);
      if (any(lessThan(p, volumes[v].bounds_min)) || any(greaterThan(p, volumes[v].bounds_max))) continue;
      const VolumeMatter matter = matter_around(volumes[v], v, p, vec3(0.125));
      sum += evenly_scattering(matter.density * look.extinction / 64.0, matter.albedo * look.multiple_scattering,
                     look.anisotropy);
    }
  }
  return sum;
}

#endif
