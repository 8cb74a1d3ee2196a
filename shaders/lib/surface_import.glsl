// Import of a host's depth.
#ifndef SURFACE_IMPORT_GLSL
#define SURFACE_IMPORT_GLSL
#include "shared/surface_import.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = kBindImportedDepth, r32f) uniform writeonly image2D depth_image;
layout(scalar, push_constant) uniform Push { SurfaceImportParams params; };

/// Reverse depth from a depth of the host; 0 without a surface.
float reverse_depth(float d) {
  const float affine = d == params.none ? 0.0 : max((d - params.offset) * params.scale, 0.0);
  return params.is_parallel != 0u && affine > 0.0 ? 1.0 / affine : affine;
}

#endif
