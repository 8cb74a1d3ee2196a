// A tile of blue noise, four independent channels, moved from frame to frame.
#ifndef BLUE_NOISE_GLSL
#define BLUE_NOISE_GLSL

const int kBlueNoiseSize = 64;

/// Four values in (0, 1). Adding multiples of the golden ratio keeps each pixel's sequence over time evenly spread.
vec4 blue_noise(sampler2D tile, ivec2 px, uint frame_index) {
  const vec4 noise = texelFetch(tile, px & (kBlueNoiseSize - 1), 0);
  return fract(noise + 0.5 / 256.0 + 0.61803398875 * float(frame_index & 1023u));
}

#endif
