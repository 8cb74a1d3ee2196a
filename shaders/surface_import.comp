// Reverse depth, as gbuffer.frag leaves it, of the surfaces that a host drew.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/surface_import.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = kBindHostDepth) uniform sampler2D host_depth;
layout(binding = kBindImportedDepth, r32f) uniform writeonly image2D depth_image;
layout(scalar, push_constant) uniform Push { SurfaceImportParams params; };

void main() {
  const ivec2 px = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(uvec2(px), params.size_px))) return;
  const float d = texelFetch(host_depth, px + ivec2(params.origin_px), 0).r;
  const float depth = d == params.none ? 0.0 : max((d - params.offset) * params.near_over_scale, 0.0);
  imageStore(depth_image, px, vec4(depth));
}
