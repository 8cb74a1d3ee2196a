// Smoke over the scene: premultiplied, so one multiply-add.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/frame.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, binding = 0) readonly buffer Frame { FrameConstants frame; };
layout(binding = 1) uniform sampler2D smoke;
layout(binding = 2, rgba16f) uniform readonly image2D lit;
layout(binding = 3, rgba16f) uniform writeonly image2D picture;

void main() {
  const ivec2 px = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(uvec2(px), frame.size_px))) return;
  const vec4 s = texelFetch(smoke, px, 0);
  imageStore(picture, px, vec4(s.rgb + s.a * imageLoad(lit, px).rgb, 1.0));
}
