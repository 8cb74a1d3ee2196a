// Cells of indirect light (shared/indirect_light.h).
#ifndef INDIRECT_CELLS_GLSL
#define INDIRECT_CELLS_GLSL
#include "lib/frame.glsl"
#include "shared/dda.h"
#include "shared/indirect_light.h"

/// A ray through the cells that may hold media, from a place [cells] over a distance [cells].
Dda ray_in_media(IndirectParams params, vec3 p_cells, vec3 direction, float reach) {
  return dda_begin(p_cells, direction, params.media_low, params.media_high, 1, 0.0, reach);
}

/// Length of a ray in its cell [m].
float length_in_cell(Dda ray) {
  return (min(dda_min(dda_leave(ray)), ray.t_end) - ray.t) * frame.indirect.cell_size;
}

/// Scattering coefficient and extinction of a medium, as of a similar one that scatters evenly.
vec4 evenly_scattering(float extinction, vec3 albedo, float g) {
  const float mean = dot(albedo, vec3(1.0 / 3.0));
  return extinction * vec4(albedo * (1.0 - g), 1.0 - mean * g);
}

vec3 indirect_from_world(vec3 p_world) { return (p_world - frame.indirect.origin_world) / frame.indirect.cell_size; }
vec3 world_from_indirect(vec3 p_cells) { return frame.indirect.origin_world + p_cells * frame.indirect.cell_size; }

#endif
