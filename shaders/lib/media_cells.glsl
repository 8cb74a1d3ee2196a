// The media of a frame in the cells of indirect light (shared/indirect_light.h). The includer defines the constant
// kMedia, the set of those that are present.
#ifndef MEDIA_CELLS_GLSL
#define MEDIA_CELLS_GLSL
#include "lib/media_set.glsl"
#include "lib/smoke_cells.glsl"
#include "lib/volume_cells.glsl"

/// Scattering coefficient and extinction of all media in a cell, as of media that scatter evenly.
vec4 media_in_cell(ivec3 cell) {
  vec4 sum = vec4(0.0);
  if (kHasSmoke) sum += smoke_in_cell(cell);
  if (kHasVolumes) sum += volumes_in_cell(cell);
  return sum;
}

#endif
