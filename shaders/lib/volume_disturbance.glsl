// Noise that moves the places at which a volume is sampled: a flame that flickers. The includer defines the constant
// kMedia.
#ifndef VOLUME_DISTURBANCE_GLSL
#define VOLUME_DISTURBANCE_GLSL
#include "lib/noise_tile.glsl"
#include "lib/volume_effects.glsl"
#include "lib/volume_values.glsl"
#include "shared/media.h"

const bool kHasDisturbance = (kMedia & kMediumDisturbed) != 0u;
/// Of a span that is not that of a brick: noise moves each of its samples.
const uint kDisturbedSlot = 0xfffffffdu;

/// The largest displacement [voxels].
vec3 disturbance_of(uint i) { return kHasDisturbance ? volume_effects[i].amplitude : vec3(0.0); }

bool is_disturbed(uint i) { return kHasDisturbance && volume_effects[i].amplitude.x > 0.0; }

/// Where a sample of volume i at a point of its voxel space is taken. Three channels of the tile at two places far
/// apart, each uniform in [0, 1], are one vector.
vec3 disturbed(uint i, vec3 p_voxel) {
  const VolumeEffect effect = volume_effects[i];
  const vec3 tile = p_voxel * effect.tiles_per_voxel + effect.tile_offset;
  const vec2 a = textureLod(noise_tile, tile, 0.0).ra;
  const float b = textureLod(noise_tile, tile + vec3(0.37, 0.71, 0.13), 0.0).a;
  const float grown = clamp(dot(effect.growth.xyz, p_voxel) + effect.growth.w, 0.0, 1.0);
  return p_voxel + (2.0 * vec3(a.y, b, a.x) - 1.0) * effect.amplitude * grown;
}

#endif
