// Cells of indirect light (shared/indirect_light.h).
#ifndef INDIRECT_CELLS_GLSL
#define INDIRECT_CELLS_GLSL
#include "lib/frame.glsl"
#include "shared/indirect_light.h"

/// Mean transmittance from a cell of this extinction to the half cell around it, over its points: as much light as
/// enters the cell is lost in it, however dense it is.
float out_of_cell(float extinction) {
  const float depth = extinction * frame.indirect.cell_size;
  return depth > 1e-3 ? (1.0 - exp(-depth)) / depth : 1.0;
}

vec3 indirect_from_world(vec3 p_world) { return (p_world - frame.indirect.origin_world) / frame.indirect.cell_size; }

#endif
