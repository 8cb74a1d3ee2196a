// A tile of blue noise with four independent channels that changes from frame to frame.
#ifndef BLUE_NOISE_GLSL
#define BLUE_NOISE_GLSL
#include "shared/noise.h"

const int kBlueNoiseSize = 64;

/// Four values in (0, 1). Multiples of the golden ratio distribute each pixel's sequence over time evenly.
vec4 blue_noise(sampler2D tile, ivec2 px, uint frame_index) {
  const vec4 noise = texelFetch(tile, px & (kBlueNoiseSize - 1), 0);
  return fract(noise + 0.5 / 256.0 + 0.61803398875 * float(frame_index & 1023u));
}

#endif
