// Smoke between the lights and the surfaces that they reach: an atlas of transmittances, one a direction from a light up to
// the first surface.
//
// Six faces a light, those of its shadow cube; a directional light has its one view as the first. A face has a
// rectangle of the atlas for the part of it in which there can be smoke, with a texel around that sees none; elsewhere
// its transmittance is 1. Transmittance, not optical depth: between two texels light goes over evenly, and a small hole
// does not shrink.
#ifndef BRUME_SMOKE_SHADOW_H
#define BRUME_SMOKE_SHADOW_H
#include "shared/shim.h"
SHARED_BEGIN

/// Edge of the blocks of texels that a workgroup marches.
SHARED_CONST uint kSmokeShadowBlock = 8u;
SHARED_CONST uint kFacesPerLight = 6u;

struct SmokeShadowFace {
  float scale;        // texels per unit of uv on the face
  vec2 offset;        // texel of the atlas = scale * uv + offset
  uint first_block;   // how many blocks the faces before have
  uvec2 first_texel;  // of the rectangle
  uvec2 size;         // texels; 0: no smoke
};
SHARED_SIZE(SmokeShadowFace, 32);

struct SmokeShadowParams {
  uint face_count;
  float step_length;  // through the smoke [m]; longer where more than 64 would be needed
  // Of each rectangle every `spread`th texel along both axes is marched, from its texel `first` on.
  uint spread;
  uvec2 first;
};
SHARED_SIZE(SmokeShadowParams, 20);

/// Blocks of a rectangle of which every `spread`th texel is marched.
SHARED_FUNCTION uvec2 smoke_shadow_blocks(uvec2 texels, uint spread) {
  return (texels + uvec2(kSmokeShadowBlock * spread - 1u)) / (kSmokeShadowBlock * spread);
}

SHARED_END
#endif
