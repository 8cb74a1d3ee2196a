// Debug views: what each one shows, and how its numbers map to colours. Colours are encoded as sRGB.
#ifndef BRUME_DEBUG_VIEW_H
#define BRUME_DEBUG_VIEW_H
#include "shared/ramp.h"
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindLevelWords, 46u);
SHARED_BINDING(kBindDistances, 47u);

SHARED_CONST uint kViewNone = 0u;
SHARED_CONST uint kViewSolid = 1u;     // the level's voxels
SHARED_CONST uint kViewDistance = 2u;  // from the smoke's source to each voxel
SHARED_CONST uint kViewDensity = 3u;   // of the smoke on a slice
SHARED_CONST uint kViewLight = 4u;     // that the smoke on a slice scatters towards the eye
SHARED_CONST uint kViewHoles = 5u;     // length of a ray that holes clear
SHARED_CONST uint kViewSteps = 6u;     // of the march
SHARED_CONST uint kViewBricks = 7u;    // of the smoke, and the filled part of each
SHARED_CONST uint kViewNormals = 8u;
SHARED_CONST uint kViewAlbedo = 9u;
SHARED_CONST uint kViewDepth = 10u;
SHARED_CONST uint kViewOverdraw = 11u;  // quads of particles on a pixel
SHARED_CONST uint kViewCount = 12u;

/// Colour ramp of a view.
SHARED_FUNCTION uint ramp_of_view(uint view) {
  if (view == kViewDensity) return kRampMagma;
  if (view == kViewHoles) return kRampPlasma;
  if (view == kViewSteps || view == kViewOverdraw) return kRampInferno;
  return kRampViridis;
}

/// A label is six glyphs of 5 bits, the first in the lowest bits: 0 to 9 are digits, then these.
SHARED_CONST uint kGlyphPoint = 10u;
SHARED_CONST uint kGlyphMetre = 11u;
SHARED_CONST uint kGlyphPlus = 12u;
SHARED_CONST uint kGlyphNone = 31u;
SHARED_CONST uint kLabelGlyphs = 6u;

/// Parameters of a view besides the frame's constants.
struct DebugViewParams {
  ivec3 grid_size;         // of the level [voxels]
  float voxel_size;        // [m]
  vec3 grid_origin_world;  // [m]
  int slice_axis;          // 0, 1 or 2: perpendicular to x, y or z
  ivec3 root_size;         // of the level [nodes of 64^3 voxels]
  float slice_world;       // position of the slice along that axis [m]
  uvec3 labels;            // of the ramp's start, middle and end; 0: no ramp
  float full;              // value at the ramp's end
};
SHARED_SIZE(DebugViewParams, 64);

/// Distance entry of a voxel: 0 without smoke, kUnreached where smoke has no path from a source, otherwise the length
/// of the path in tenths of a voxel edge, plus 1.
SHARED_CONST uint kUnreached = 0xffffffffu;

/// The depth view is 1 at kDepthNear, 0 at kDepthFar [m], and linear in the logarithm of the distance.
SHARED_CONST float kDepthNear = 1.0f;
SHARED_CONST float kDepthFar = 64.0f;
SHARED_FUNCTION float depth_fraction(float distance_m) {
  return 1.0f - clamp(log(distance_m / kDepthNear) / log(kDepthFar / kDepthNear), 0.0f, 1.0f);
}

/// Opacity of a view where a surface occludes it.
SHARED_CONST float kOccludedOpacity = 0.45f;

/// Background colour.
SHARED_FUNCTION vec3 backdrop() {
  return vec3(0.055f, 0.062f, 0.078f);
}

/// The scene behind a view, in grey, as if lit from the eye. `luminance` of the albedo and `facing`, the cosine between
/// normal and ray, in [0, 1].
SHARED_FUNCTION vec3 dimmed_surface(float luminance, float facing) {
  return mix(backdrop(), vec3(0.42f, 0.45f, 0.5f), (0.25f + 0.75f * sqrt(luminance)) * (0.2f + 0.8f * facing));
}

/// Colour of a voxel face: each direction has its own tone, so shapes read without a light. Normal 0: the eye is inside
/// the voxel.
SHARED_FUNCTION vec3 face_tone(ivec3 normal) {
  if (normal.y > 0) return vec3(0.88f, 0.89f, 0.86f);
  if (normal.y < 0) return vec3(0.36f, 0.35f, 0.38f);
  if (normal.x != 0) return normal.x > 0 ? vec3(0.62f, 0.67f, 0.74f) : vec3(0.54f, 0.59f, 0.67f);
  if (normal.z != 0) return normal.z > 0 ? vec3(0.76f, 0.72f, 0.66f) : vec3(0.66f, 0.62f, 0.57f);
  return vec3(0.45f, 0.2f, 0.2f);
}

/// Ambient occlusion at a corner of a face from the three voxels that may stand on it: Lysenko 2013 ("Ambient occlusion
/// for Minecraft-like worlds").
SHARED_FUNCTION float corner_light(uint side_a, uint side_b, uint corner) {
  uint occluders = side_a + side_b + (side_a * side_b != 0u ? 1u : corner);
  return 1.0f - 0.17f * float(occluders);
}

/// The same, interpolated at a point f in [0, 1]^2 of a face. `around`: a bit for each of the eight neighbours of the
/// voxel in front of the face, (du + 1) + 3 (dv + 1).
SHARED_FUNCTION float face_light(uint around, vec2 f) {
  uint left = around >> 3u & 1u, right = around >> 5u & 1u, low = around >> 1u & 1u, high = around >> 7u & 1u;
  float low_row = mix(corner_light(left, low, around & 1u), corner_light(right, low, around >> 2u & 1u), f.x);
  float high_row = mix(corner_light(left, high, around >> 6u & 1u), corner_light(right, high, around >> 8u & 1u), f.x);
  return mix(low_row, high_row, f.y);
}

/// Coverage of a line at a distance from its middle; `width` of a pixel in the same unit.
SHARED_FUNCTION float line_coverage(float distance, float width) {
  return 1.0f - smoothstep(0.5f * width, 1.5f * width, distance);
}

/// Coverage of the lines around a face at a point of it; fades where voxels are as small as pixels.
SHARED_FUNCTION float grid_line(vec2 f, float width) {
  vec2 to_edge = min(f, vec2(1.0f) - f);
  return line_coverage(min(to_edge.x, to_edge.y), width) * clamp(1.0f - 3.0f * width, 0.0f, 1.0f);
}

/// A voxel of the level, `distance_m` from the eye.
SHARED_FUNCTION vec3 solid_colour(ivec3 normal, float light, float line, float distance_m) {
  vec3 colour = face_tone(normal) * light * (1.0f - 0.22f * line);
  return mix(backdrop(), colour, 0.55f + 0.45f * exp(-distance_m / 30.0f));
}

/// Brightness of a face of a smoke voxel; keeps the colour readable.
SHARED_FUNCTION float distance_tone(ivec3 normal) {
  return 0.45f + 0.62f * face_tone(normal).y;
}

/// A voxel of the smoke by its distance from the source. `entry` is its distance entry, not 0.
SHARED_FUNCTION vec3 distance_colour(uint entry, float metres, float full) {
  return entry == kUnreached ? vec3(0.5f) : ramp_colour(kRampViridis, metres / full);
}

/// A slice where it is free of smoke, and where it cuts solid voxels; `line`: coverage of voxel edges.
SHARED_FUNCTION vec3 slice_air(float line, vec3 behind) {
  return mix(behind, vec3(0.3f, 0.36f, 0.44f), 0.10f + 0.14f * line);
}
SHARED_FUNCTION vec3 slice_wall(float line) {
  return vec3(0.012f, 0.014f, 0.02f) + vec3(0.05f * line);
}

/// Density on a slice, over the colour behind it.
SHARED_FUNCTION vec3 density_colour(float density, vec3 behind) {
  return mix(behind, ramp_colour(ramp_of_view(kViewDensity), density), smoothstep(0.0f, 0.06f, density));
}

/// A value in [0, 1] on a ramp over the dimmed scene: transparent at 0, opaque from 0.05.
SHARED_FUNCTION vec3 heat_colour(uint ramp, float x, vec3 behind) {
  return mix(behind, ramp_colour(ramp, x), smoothstep(0.0f, 0.05f, x));
}

SHARED_END
#endif
