// Decals of baked occlusion.
#ifndef BRUME_DECAL_H
#define BRUME_DECAL_H
#include "shared/shim.h"
#include "shared/slice_texture.h"
SHARED_BEGIN

SHARED_BINDING(kBindDecals, 61u);
SHARED_BINDING(kBindPastOcclusion, 62u);
SHARED_BINDING(kBindOcclusion, 63u);

/// The most decals of a frame.
SHARED_CONST uint kMaxDecals = 32u;

struct Decal {
  Affine uvw_from_world;  // the box is [0, 1]^3; planes lie across v
  vec3 low_world;         // bounds of the box
  float radius;           // about how far what hides reaches [m]; 0: unknown
  vec3 high_world;
  float strength;
  vec3 up_world;          // unit: where the planes of the first channel face
  float gamma_off;        // what the exponent of the occlusion is more than 1 at the middle plane
  vec3 middle_world;      // of what hides
  float falloff;          // how fast gamma_off fades towards the ends
  vec3 scatter;           // how far noise scatters the samples, in uvw
  float fade;             // part of the box, at each side, over which the decal fades out
  SliceTexture occlusion; // of what faces up, and of what faces down
  vec2 padding SHARED_ZERO;
};
SHARED_SIZE(Decal, 176);

struct DecalParams {
  mat4 past_from_world;  // planning::PastView of the frame before
  uvec2 past_size_px;    // its size, which may be another one
  uint past_frames;      // in a row before this one; 0: none, and a frame takes all samples itself
  uint decal_count;
};
SHARED_SIZE(DecalParams, 80);

/// Samples of a pixel without a past; with one it takes a single sample.
SHARED_CONST uint kDecalSamples = 8u;
/// Of how many samples the occlusion is the mean, at most: of more, it is a mean that fades with time.
SHARED_CONST float kDecalMeanSamples = 8.0f;

/// The exponent of the occlusion at v in [0, 1] (bake::combine_occlusion).
SHARED_FUNCTION float occlusion_exponent(float gamma_off, float falloff, float v) {
  return 1.0f + gamma_off * pow(max(1.0f - abs(2.0f * v - 1.0f), 1e-6f), falloff);
}

SHARED_END
#endif
