// Sky light of each texel from the rays of sky_rays.comp.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/frame.glsl"
#include "shared/sky_light.h"

layout(local_size_x = 64) in;
layout(scalar, binding = kBindSkyRays) readonly buffer Rays { uint sky_words[]; };
layout(binding = kBindSkyLight, rgba16f) uniform writeonly image3D sky_light;

void main() {
  const ivec3 size = frame.solid.size;
  const int row_words = solid_row_words(size.x), row = int(gl_GlobalInvocationID.y), x = int(gl_GlobalInvocationID.x);
  if (x >= size.x || row >= size.y * size.z) return;
  const int word = row * row_words + (x >> 5), words = row_words * size.y * size.z;

  vec4 sum = vec4(0.0);
  for (uint i = 0u; i < kSkyDirections; ++i) {
    const float visible = float(sky_words[int(i) * words + word] >> (x & 31) & 1u);
    const vec3 d = sky_direction(i);
    sum += visible * sky_weight(i) * sky_shape(d.y) * vec4(1.0, 3.0 * d);
  }
  imageStore(sky_light, ivec3(x, row % size.y, row / size.y), sum);
}
