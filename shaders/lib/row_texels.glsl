// Texels listed in the rows of shared/smoke_light.h. The includer has `rows`.
#ifndef ROW_TEXELS_GLSL
#define ROW_TEXELS_GLSL
#include "shared/smoke_light.h"

/// Entries of a row selected by `texels` (phase_range or kNewTexels): the first, and one past the last.
uvec2 row_entries(uint row, uint texels) {
  const uint head = row * kTexelListWords;
  if (texels == kNewTexels) return uvec2(0u, rows[head + kLightPhases + 1u]);
  return uvec2(rows[head + (texels & 0xffu)], rows[head + (texels >> 8u)]);
}

uint row_texel(uint row, uint texels, uint entry) {
  const uint word = rows[row * kTexelListWords + kTexelListHead + entry];
  return texels == kNewTexels ? word >> 16u : word & 0xffffu;
}

#endif
