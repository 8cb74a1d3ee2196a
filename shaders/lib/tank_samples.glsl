// Random numbers of the paths of a tank: for each pair of dimensions Owen-scrambled Sobol points, moved by blue
// noise from pixel to pixel, so that what is left of the noise is blue, too.
#ifndef TANK_SAMPLES_GLSL
#define TANK_SAMPLES_GLSL
#include "lib/low_discrepancy.glsl"
#include "shared/hash.h"
#include "shared/noise.h"

layout(binding = kBindBlueNoise) uniform sampler2D blue_noise_tile;

/// The numbers of a sample of a pixel.
struct SampleSource {
  ivec2 px;
  uint index;      // of the sample
  uint dimension;  // pairs taken so far
};

/// The next two, evenly distributed in [0, 1)^2.
vec2 next_point(inout SampleSource source) {
  const uint k = source.dimension++;
  const vec2 point = sobol_point(source.index, 0x9e3779b9u * (k + 1u));
  const ivec2 texel = (source.px + ivec2(k * uvec2(29u, 47u))) & 63;
  const vec2 noise = texelFetch(blue_noise_tile, texel, 0).rg * (255.0 / 256.0);
  // The tile has 8 bits.
  const vec2 low_bits = hash3(uvec3(source.px, k)).xy * (1.0 / 256.0);
  return min(fract(point + noise + low_bits), 1.0 - 1.0 / 16777216.0);
}

/// What names a ray of the path.
uint next_seed(inout SampleSource source) {
  return pcg3d(uvec3(source.px, source.index * 64u + source.dimension++)).x;
}

#endif
