// A layer over those so far.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/layers.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = kBindOverLayer) uniform sampler2D over_layer;
layout(binding = kBindUnderLayers, rgba16f) uniform image2D layers;

void main() {
  const ivec2 px = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(px, imageSize(layers)))) return;
  const vec4 over = texelFetch(over_layer, px, 0), under = imageLoad(layers, px);
  imageStore(layers, px, vec4(over.rgb + over.a * under.rgb, over.a * under.a));
}
