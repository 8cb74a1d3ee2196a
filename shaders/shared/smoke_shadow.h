// Shadows of smoke on surfaces: an atlas of transmittances from each light to the first surface, one per direction.
//
// Six faces per light, those of its shadow cube; a directional light uses the first for its one view. A face has a
// rectangle of the atlas for the part that may see smoke, with a border of one texel that sees none; elsewhere its
// transmittance is 1. The atlas stores transmittance, not optical depth: light then interpolates linearly between
// texels, and a small hole does not shrink.
#ifndef BRUME_SMOKE_SHADOW_H
#define BRUME_SMOKE_SHADOW_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindSmokeShadows, 42u);
SHARED_BINDING(kBindSmokeShadowFaces, 43u);

/// Edge of the block of texels that a workgroup marches.
SHARED_CONST uint kSmokeShadowBlock = 8u;
SHARED_CONST uint kFacesPerLight = 6u;

struct SmokeShadowFace {
  float scale;        // texels per unit of uv on the face
  vec2 offset;        // texel of the atlas = scale * uv + offset
  uint first_block;   // number of blocks of all faces before this one
  uvec2 first_texel;  // of the rectangle
  uvec2 size;         // texels; 0: no smoke
};
SHARED_SIZE(SmokeShadowFace, 32);

struct SmokeShadowParams {
  // Marches every `spread`th texel of each rectangle along both axes, starting at its texel `first`.
  uvec2 first;
  uint spread;
  uint face_count;
  float step_length;  // through the smoke [m]; longer where a ray would take more than 64 steps
};
SHARED_SIZE(SmokeShadowParams, 20);

/// Blocks per axis of a rectangle of which every `spread`th texel is marched.
SHARED_FUNCTION uvec2 smoke_shadow_blocks(uvec2 texels, uint spread) {
  return (texels + uvec2(kSmokeShadowBlock * spread - 1u)) / (kSmokeShadowBlock * spread);
}

SHARED_END
#endif
