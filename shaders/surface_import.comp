// Reverse depth, as gbuffer.frag leaves it, of the surfaces that a host drew.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/surface_import.glsl"

layout(binding = kBindHostDepth) uniform sampler2D host_depth;

void main() {
  const ivec2 px = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(uvec2(px), params.size_px))) return;
  const float d = texelFetch(host_depth, px + ivec2(params.origin_px), 0).r;
  imageStore(depth_image, px, vec4(reverse_depth(d)));
}
