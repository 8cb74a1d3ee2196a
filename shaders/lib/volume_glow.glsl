// What volumes besides the smoke emit by heat and by masks, per metre. The includer defines the constant kMedia.
#ifndef VOLUME_GLOW_GLSL
#define VOLUME_GLOW_GLSL
#include "lib/volume_effects.glsl"
#include "lib/volume_transfer.glsl"
#include "shared/media.h"

// Constants of the pipeline: a software rasteriser pays for branches that it does not take.
const bool kHasHeat = (kMedia & kMediumHeat) != 0u;
const bool kHasMasks = (kMedia & kMediumMasks) != 0u;

layout(binding = kBindVolumeColors) uniform sampler2D volume_colors;
layout(binding = kBindMaskPairs) uniform sampler3D mask_pairs;

/// What a volume's heat emits at a point, per metre and per look.extinction.
vec3 volume_glow(uint i, vec3 p_world) {
  const vec3 p_heat = matrix_of(volumes[i].heat_from_world) * vec4(p_world, 1.0);
  const float heat = volume_value(volumes[i].heat_bricks, p_heat);
  if (heat <= 0.0) return vec3(0.0);
  const vec2 size = vec2(textureSize(volume_colors, 0));
  const float column = clamp(heat * volumes[i].heat_per_value, 0.0, 1.0) * (size.x - 1.0) + 0.5;
  return textureLod(volume_colors, vec2(column, float(i) + 0.5) / size, 0.0).rgb;
}

/// The masks of a volume at a place in its atlas.
vec4 masks_at(uint i, vec3 uvw) {
  if (volumes[i].color_kind == kColorsPair) return vec4(textureLod(mask_pairs, uvw, 0.0).rg, 0.0, 0.0);
  return textureLod(color_grids, uvw, 0.0);
}

#endif
