// Replaces the radiance of a frame by the mean of the frames of its picture so far.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/average.h"
#include "shared/display.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = kBindRadiance, rgba16f) uniform image2D radiance_image;
layout(binding = kBindRadianceSum, rgba32f) uniform image2D sum_image;
layout(push_constant, scalar) uniform Constants { AverageConstants constants; };

void main() {
  const ivec2 px = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(uvec2(px), constants.size_px))) return;
  // Next to a light source the radiance exceeds a half float.
  vec4 sum = min(imageLoad(radiance_image, px), 65504.0);
  if (constants.index > 0u) sum += imageLoad(sum_image, px);
  imageStore(sum_image, px, sum);
  imageStore(radiance_image, px, sum / float(constants.index + 1u));
}
