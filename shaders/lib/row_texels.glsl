// Texels of a brick by the rows of shared/smoke_light.h. The includer has `rows`.
#ifndef ROW_TEXELS_GLSL
#define ROW_TEXELS_GLSL
#include "shared/smoke_light.h"

const uint kNoTexel = 0xffffffffu;

/// Texel i of those of a row that are asked for; kNoTexel behind the last.
uint row_texel(uint row, uint texels, uint i) {
  const bool fresh = texels == kNewTexels;
  const uint head = row * kLightRow;
  const uint at = i + (fresh ? 0u : rows[head + (texels & 0xffu)]);
  if (at >= rows[head + (fresh ? kLightPhases + 1u : texels >> 8u)]) return kNoTexel;
  const uint word = rows[head + kLightRowHead + at];
  return fresh ? word >> 16u : word & 0xffffu;
}

#endif
