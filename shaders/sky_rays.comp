// Visibility of the sky from each texel in one of 32 directions. Traces 32 texels of a row at a time, as bits of a word
// that moves through the level. A ray tests one texel per step along its longest axis; the path between two of its
// points lies inside their two texels, so a voxelized surface without gaps stops it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/frame.glsl"
#include "shared/sky_light.h"

layout(local_size_x = 64) in;
layout(scalar, binding = kBindSolidWords) readonly buffer Words { uint solid_words[]; };
layout(scalar, binding = kBindSkyRays) writeonly buffer Rays {
  uint sky_words[];  // per direction as many as solid_words
};

/// 32 texels of a row from x on, as bits; 0 beyond its ends.
uint solid_bits(int row, int x, int row_words) {
  const int word = x >> 5, shift = x & 31;
  const uint low = word >= 0 && word < row_words ? solid_words[row * row_words + word] : 0u;
  if (shift == 0) return low;
  const uint high = word + 1 >= 0 && word + 1 < row_words ? solid_words[row * row_words + word + 1] : 0u;
  return low >> shift | high << (32 - shift);
}

void main() {
  const ivec3 size = frame.solid.size;
  const int row_words = solid_row_words(size.x), word = int(gl_GlobalInvocationID.x);
  if (word >= row_words * size.y * size.z) return;
  const int row = word / row_words;
  const ivec3 at = ivec3(word % row_words * 32, row % size.y, row / size.y);
  const ivec3 slope = sky_slope(gl_GlobalInvocationID.y);

  uint visible = ~solid_words[word];
  for (int i = 1; visible != 0u; ++i) {
    const ivec3 p = at + sky_step(slope, i);
    const bool outside = p.x <= -32 || p.x >= size.x || any(lessThan(p.yz, ivec2(0)));
    if (outside || any(greaterThanEqual(p.yz, size.yz))) break;
    visible &= ~solid_bits(p.y + size.y * p.z, p.x, row_words);
  }
  sky_words[int(gl_GlobalInvocationID.y) * row_words * size.y * size.z + word] = visible;
}
