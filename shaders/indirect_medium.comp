// The media in each cell.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/indirect_light.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(constant_id = 0) const uint kMedia = 0u;
layout(binding = kBindIndirectTarget, rgba16f) uniform writeonly image3D target;
layout(scalar, push_constant) uniform Push { IndirectParams params; };
#include "lib/media_cells.glsl"

void main() {
  const ivec3 cell = params.media_low + ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(cell, params.media_high))) return;
  imageStore(target, cell, media_in_cell(cell));
}
