// Cells of indirect light (shared/indirect_light.h).
#ifndef INDIRECT_CELLS_GLSL
#define INDIRECT_CELLS_GLSL
#include "lib/frame.glsl"
#include "lib/brick_rays.glsl"
#include "shared/indirect_light.h"

/// Mean transmittance from a cell of this extinction to the half cell around it, over its points: as much light as
/// enters the cell is lost in it, however dense it is.
float out_of_cell(float extinction) {
  const float depth = extinction * frame.indirect.cell_size;
  return depth > 1e-3 ? (1.0 - exp(-depth)) / depth : 1.0;
}

/// The part of a ray inside the cells that may hold media, between two distances [cells]: x >= y where there is none.
vec2 span_in_media(IndirectParams params, vec3 p_cells, vec3 direction, float nearest, float reach) {
  const vec2 inside = span_in_box(VoxelRay(p_cells, direction), vec3(params.media_low), vec3(params.media_high));
  return vec2(max(inside.x, nearest), min(inside.y, reach));
}

vec3 indirect_from_world(vec3 p_world) { return (p_world - frame.indirect.origin_world) / frame.indirect.cell_size; }

#endif
