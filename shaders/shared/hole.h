// A hole that a shot leaves in smoke, and the fraction of the density that it removes at a point and a time.
//
//            time_to_reach_far              Cross-section at depth z, after the front has passed:
//   origin |------------------->| far          opens over time_to_expand, stays open for time_to_stay_open,
//          z = 0      front                    then narrows and fades over time_to_fade
#ifndef BRUME_HOLE_H
#define BRUME_HOLE_H
#include "shared/shim.h"
SHARED_BEGIN

/// Cross-section of a hole.
SHARED_CONST uint kHoleCylinder = 0u;
SHARED_CONST uint kHoleBox = 1u;
SHARED_CONST uint kHoleMask = 2u;  // a box whose cross-section is an image

/// Width of the soft edge of a cylinder or box, as a fraction of the radius.
SHARED_CONST float kHoleSoftFraction = 0.4f;

/// `forward`, `right` and `up` are orthonormal.
struct Hole {
  vec3 origin_world;        // [m]
  float radius;             // of the open hole; half the edge of a box or mask [m]
  vec3 forward;             // direction of the shot: local +z
  float distance_to_far;    // depth of the hole [m], > 0
  vec3 right;               // local +x
  float time_start;         // when the shot was fired [s]
  vec3 up;                  // local +y
  float time_to_reach_far;  // time of the front from z = 0 to distance_to_far [s]
  float time_to_expand;     // [s]
  float time_to_stay_open;  // after it is wide open [s]
  float time_to_fade;       // [s]
  uint shape;               // kHoleCylinder, kHoleBox or kHoleMask
  vec2 uv_min, uv_max;      // of the mask in the mask atlas, (0, 0) at the corner of its first texel; masks only
};
SHARED_SIZE(Hole, 96);

/// Amplitude of the noise on the rim, `rim` [m] or less: at most a quarter of the radius, so that narrow holes persist.
SHARED_FUNCTION float hole_rim(Hole hole, float rim) { return min(rim, 0.25f * hole.radius); }

/// Largest distance of a hole's point from its axis, in radii: the corner of a box whose rim is moved outward.
SHARED_CONST float kHoleWidest = 1.7682f;

/// Opening of a hole at a depth, as fractions of its radius and of its full strength.
struct HoleOpening {
  float radius;
  float strength;
};
SHARED_LOCAL(HoleOpening);

/// `age`: time since the front passed [s], above 0; the other times as in Hole.
SHARED_FUNCTION HoleOpening hole_opening(float age, float time_to_expand, float time_to_stay_open, float time_to_fade) {
  float opened = clamp(age / max(time_to_expand, 1e-6f), 0.0f, 1.0f);
  float closing_age = age - time_to_expand - time_to_stay_open;
  float remaining = 1.0f - clamp(closing_age / max(time_to_fade, 1e-6f), 0.0f, 1.0f);
  HoleOpening opening;
  opening.radius = opened * remaining;
  opening.strength = remaining;
  return opening;
}

/// Fraction removed inside the radius of a cylinder or box; 0 at its edge.
SHARED_FUNCTION float hole_edge(float from_axis, float radius) {
  return smoothstep(0.0f, 1.0f, (radius - from_axis) / (radius * kHoleSoftFraction));
}

/// Position of a point across a mask, [0, 1], with the first row of the image on top.
SHARED_FUNCTION vec2 hole_mask_position(float x, float y, float radius) {
  return clamp(vec2(0.5f + 0.5f * x / radius, 0.5f - 0.5f * y / radius), vec2(0.0f), vec2(1.0f));
}

/// Effect of a hole at a point.
struct HoleCut {
  float strength;  // fraction of the smoke that it removes, [0, 1]; of a mask: where its image is white
  vec2 uv;         // position in the mask atlas; masks only
};
SHARED_LOCAL(HoleCut);

/// `time` is on the clock of Hole::time_start. Removes nothing before the front has passed, nor at depths below 0 or
/// above distance_to_far. rim_noise_metres widens (above 0) or narrows the hole at this point.
SHARED_FUNCTION HoleCut hole_cut(Hole hole, vec3 p_world, float time, float rim_noise_metres) {
  HoleCut cut;
  cut.strength = 0.0f;
  cut.uv = hole.uv_min;
  vec3 from_origin = p_world - hole.origin_world;
  float z = dot(from_origin, hole.forward);
  if (z < 0.0f || z > hole.distance_to_far) return cut;

  // Time since the front passed this depth.
  float age = time - hole.time_start - z / max(hole.distance_to_far, 1e-6f) * hole.time_to_reach_far;
  if (age <= 0.0f) return cut;
  HoleOpening opening = hole_opening(age, hole.time_to_expand, hole.time_to_stay_open, hole.time_to_fade);
  if (opening.strength <= 0.0f) return cut;

  float radius = (hole.radius + rim_noise_metres) * opening.radius;
  float x = dot(from_origin, hole.right);
  float y = dot(from_origin, hole.up);
  float from_axis = hole.shape == kHoleCylinder ? length(vec2(x, y)) : max(abs(x), abs(y));
  if (from_axis >= radius) return cut;

  cut.strength = opening.strength;
  if (hole.shape == kHoleMask) {
    cut.uv = mix(hole.uv_min, hole.uv_max, hole_mask_position(x, y, radius));
  } else {
    cut.strength *= hole_edge(from_axis, radius);
  }
  return cut;
}

/// Fraction of the smoke that the hole removes at a point, [0, 1]; a mask as if its image were white.
SHARED_FUNCTION float hole_strength(Hole hole, vec3 p_world, float time, float rim_noise_metres) {
  return hole_cut(hole, p_world, time, rim_noise_metres).strength;
}

/// A Hole in six rows of 16 bytes, each one load. A wide open cylinder, the common case, is read from the first two.
///
/// Those rows have no room for a word of flags: their last words hold a positive float, whose sign bit is a flag.
struct PackedHole {
  vec4 origin_radius;  // w: hole_word(radius, whether the hole is partial)
  vec4 forward_far;    // w: hole_word(distance_to_far, whether it is round)
  vec4 right_start;    // w: time_start
  vec4 up_reach;       // w: time_to_reach_far
  uvec4 times_shape;   // bits of time_to_expand, time_to_stay_open and time_to_fade; w: shape
  vec4 uv;             // xy: uv_min, zw: uv_max
};
SHARED_SIZE(PackedHole, 96);

/// A number above 0 and a flag in one word. abs is free on a GPU, so reading the number is too.
SHARED_FUNCTION float hole_word(float number, bool flag) { return flag ? -number : number; }
SHARED_FUNCTION float hole_number(float word) { return abs(word); }
SHARED_FUNCTION bool hole_flag(float word) { return word < 0.0f; }

/// Whether a hole opens or closes somewhere along its axis, or has a mask: more than the first two rows matter.
SHARED_FUNCTION bool hole_is_partial(vec4 origin_radius) { return hole_flag(origin_radius.w); }
/// Whether it is a cylinder: the distance from its axis is the only coordinate across.
SHARED_FUNCTION bool hole_is_round(vec4 forward_far) { return hole_flag(forward_far.w); }

/// `wide_open`: hole_opening is 1 everywhere along the axis at the frame's time. False is always safe.
SHARED_FUNCTION PackedHole pack_hole(Hole hole, bool wide_open) {
  PackedHole packed;
  packed.origin_radius = vec4(hole.origin_world, hole_word(hole.radius, !wide_open || hole.shape == kHoleMask));
  packed.forward_far = vec4(hole.forward, hole_word(hole.distance_to_far, hole.shape == kHoleCylinder));
  packed.right_start = vec4(hole.right, hole.time_start);
  packed.up_reach = vec4(hole.up, hole.time_to_reach_far);
  packed.times_shape = uvec4(floatBitsToUint(hole.time_to_expand), floatBitsToUint(hole.time_to_stay_open),
                             floatBitsToUint(hole.time_to_fade), hole.shape);
  packed.uv = vec4(hole.uv_min, hole.uv_max);
  return packed;
}

SHARED_FUNCTION Hole unpack_hole(PackedHole packed) {
  Hole hole;
  hole.origin_world = vec3(packed.origin_radius.x, packed.origin_radius.y, packed.origin_radius.z);
  hole.radius = hole_number(packed.origin_radius.w);
  hole.forward = vec3(packed.forward_far.x, packed.forward_far.y, packed.forward_far.z);
  hole.distance_to_far = hole_number(packed.forward_far.w);
  hole.right = vec3(packed.right_start.x, packed.right_start.y, packed.right_start.z);
  hole.time_start = packed.right_start.w;
  hole.up = vec3(packed.up_reach.x, packed.up_reach.y, packed.up_reach.z);
  hole.time_to_reach_far = packed.up_reach.w;
  hole.time_to_expand = uintBitsToFloat(packed.times_shape.x);
  hole.time_to_stay_open = uintBitsToFloat(packed.times_shape.y);
  hole.time_to_fade = uintBitsToFloat(packed.times_shape.z);
  hole.shape = packed.times_shape.w;
  hole.uv_min = vec2(packed.uv.x, packed.uv.y);
  hole.uv_max = vec2(packed.uv.z, packed.uv.w);
  return hole;
}

SHARED_END
#endif
