// Pictures of what the picture is made from: what each shows, and how numbers become colours. Colours are encoded as sRGB.
#ifndef BRUME_DEBUG_VIEW_H
#define BRUME_DEBUG_VIEW_H
#include "shared/ramp.h"
#include "shared/shim.h"
SHARED_BEGIN

SHARED_CONST uint kViewNone = 0u;
SHARED_CONST uint kViewSolid = 1u;     // the level's voxels
SHARED_CONST uint kViewDistance = 2u;  // how far smoke had to go, voxel by voxel
SHARED_CONST uint kViewDensity = 3u;   // on a slice
SHARED_CONST uint kViewLight = 4u;     // that the smoke on a slice sends to the eye
SHARED_CONST uint kViewHoles = 5u;     // how much of a ray is cleared by holes
SHARED_CONST uint kViewSteps = 6u;     // that the march takes
SHARED_CONST uint kViewBricks = 7u;    // of the smoke that are there, and what of each is filled
SHARED_CONST uint kViewNormals = 8u;
SHARED_CONST uint kViewAlbedo = 9u;
SHARED_CONST uint kViewDepth = 10u;
SHARED_CONST uint kViewCount = 11u;

/// The ramp of a view's numbers.
SHARED_FUNCTION uint ramp_of_view(uint view) {
  if (view == kViewDensity) return kRampMagma;
  if (view == kViewHoles) return kRampPlasma;
  if (view == kViewSteps) return kRampInferno;
  return kRampViridis;
}

/// Six glyphs of 5 bits a label, the first lowest: 0 to 9 are digits, then these.
SHARED_CONST uint kGlyphPoint = 10u;
SHARED_CONST uint kGlyphMetre = 11u;
SHARED_CONST uint kGlyphPlus = 12u;
SHARED_CONST uint kGlyphNone = 31u;
SHARED_CONST uint kLabelGlyphs = 6u;

/// What a view needs besides the frame's constants.
struct DebugViewParams {
  ivec3 grid_size;         // voxels of the level
  float voxel_size;        // [m]
  vec3 grid_origin_world;  // [m]
  ivec3 root_size;         // nodes of 64^3 voxels
  int slice_axis;          // 0, 1 or 2: across x, y or z
  float slice_world;       // where the slice is along it [m]
  float full;              // the number at the end of the ramp
  uvec3 labels;            // of the ramp's begin, middle and end; 0: there is no ramp
};
SHARED_SIZE(DebugViewParams, 64);

/// A distance entry of a voxel: 0 where there is no smoke, this one where there is smoke that has no way from a source, else
/// the way in tenths of a voxel's edge, + 1.
SHARED_CONST uint kNoWay = 0xffffffffu;

/// Depth in a view of it: 1 at kDepthNear, 0 at kDepthFar [m], even in its logarithm.
SHARED_CONST float kDepthNear = 1.0f;
SHARED_CONST float kDepthFar = 64.0f;
SHARED_FUNCTION float depth_share(float distance_m) {
  return 1.0f - clamp(log(distance_m / kDepthNear) / log(kDepthFar / kDepthNear), 0.0f, 1.0f);
}

/// How much is seen of what lies behind a surface.
SHARED_CONST float kSeenThrough = 0.45f;

/// Where nothing is.
SHARED_FUNCTION vec3 backdrop() {
  return vec3(0.055f, 0.062f, 0.078f);
}

/// A surface below what a view shows: grey, seen as by a light at the eye. `luminance` and `facing`, the cosine between normal and
/// ray, in [0, 1].
SHARED_FUNCTION vec3 dimmed_surface(float luminance, float facing) {
  return mix(backdrop(), vec3(0.42f, 0.45f, 0.5f), (0.25f + 0.75f * sqrt(luminance)) * (0.2f + 0.8f * facing));
}

/// Of the face of a voxel: every direction has its own tone, so that shapes read without a light. 0: the eye is in the voxel.
SHARED_FUNCTION vec3 face_tone(ivec3 normal) {
  if (normal.y > 0) return vec3(0.88f, 0.89f, 0.86f);
  if (normal.y < 0) return vec3(0.36f, 0.35f, 0.38f);
  if (normal.x != 0) return normal.x > 0 ? vec3(0.62f, 0.67f, 0.74f) : vec3(0.54f, 0.59f, 0.67f);
  if (normal.z != 0) return normal.z > 0 ? vec3(0.76f, 0.72f, 0.66f) : vec3(0.66f, 0.62f, 0.57f);
  return vec3(0.45f, 0.2f, 0.2f);
}

/// How much of the light a corner of a face gets past three voxels that may stand on it: after Lysenko 2013 ("Ambient occlusion
/// for Minecraft-like worlds").
SHARED_FUNCTION float corner_light(uint side_a, uint side_b, uint corner) {
  uint stand = side_a + side_b + (side_a * side_b != 0u ? 1u : corner);
  return 1.0f - 0.17f * float(stand);
}

/// The same at a point f in [0, 1]^2 of a face. `around`: bits of the eight voxels before the face, around it, (du + 1) + 3 (dv + 1).
SHARED_FUNCTION float face_light(uint around, vec2 f) {
  uint left = around >> 3u & 1u, right = around >> 5u & 1u, low = around >> 1u & 1u, high = around >> 7u & 1u;
  float low_row = mix(corner_light(left, low, around & 1u), corner_light(right, low, around >> 2u & 1u), f.x);
  float high_row = mix(corner_light(left, high, around >> 6u & 1u), corner_light(right, high, around >> 8u & 1u), f.x);
  return mix(low_row, high_row, f.y);
}

/// How much of a line is at a distance from its middle; `width`, of a pixel, in the same unit.
SHARED_FUNCTION float line_share(float apart, float width) {
  return 1.0f - smoothstep(0.5f * width, 1.5f * width, apart);
}

/// The lines around a face at a point of it, faint where voxels are as small as pixels.
SHARED_FUNCTION float grid_line(vec2 f, float width) {
  vec2 apart = min(f, vec2(1.0f) - f);
  return line_share(min(apart.x, apart.y), width) * clamp(1.0f - 3.0f * width, 0.0f, 1.0f);
}

/// A level's voxel: `distance_m` from the eye.
SHARED_FUNCTION vec3 solid_colour(ivec3 normal, float light, float line, float distance_m) {
  vec3 colour = face_tone(normal) * light * (1.0f - 0.22f * line);
  return mix(backdrop(), colour, 0.55f + 0.45f * exp(-distance_m / 30.0f));
}

/// How light a face of the smoke's voxels is, so that its colour can still be read.
SHARED_FUNCTION float way_tone(ivec3 normal) {
  return 0.45f + 0.62f * face_tone(normal).y;
}

/// A voxel of the smoke, by how far its smoke came; `way` as in the entries, not 0.
SHARED_FUNCTION vec3 way_colour(uint way, float metres, float full) {
  return way == kNoWay ? vec3(0.5f) : ramp_colour(kRampViridis, metres / full);
}

/// A slice where there is no smoke, and where it cuts what is solid; `line`: of the voxels' edges.
SHARED_FUNCTION vec3 slice_air(float line, vec3 behind) {
  return mix(behind, vec3(0.3f, 0.36f, 0.44f), 0.10f + 0.14f * line);
}
SHARED_FUNCTION vec3 slice_wall(float line) {
  return vec3(0.012f, 0.014f, 0.02f) + vec3(0.05f * line);
}

/// Density on a slice, over what is behind it.
SHARED_FUNCTION vec3 density_colour(float density, vec3 behind) {
  return mix(behind, ramp_colour(ramp_of_view(kViewDensity), density), smoothstep(0.0f, 0.06f, density));
}

/// A number on a ramp over a dimmed scene: nothing below 0, all of the ramp's colour from a twentieth on.
SHARED_FUNCTION vec3 heat_colour(uint ramp, float share, vec3 behind) {
  return mix(behind, ramp_colour(ramp, share), smoothstep(0.0f, 0.05f, share));
}

SHARED_END
#endif
