// A hole that a shot leaves in smoke, and how much of the density it takes away at a point and a time.
//
//            time_to_reach_far              Cross-section at depth z, seconds after the front got there:
//   origin |------------------->| far          opens over time_to_expand, stays for time_to_stay_open,
//          z = 0      front                    then narrows and fades over time_to_fade
#ifndef BRUME_HOLE_H
#define BRUME_HOLE_H
#include "shared/shim.h"
SHARED_BEGIN

/// Cross-section of a hole.
SHARED_CONST uint kHoleCylinder = 0u;
SHARED_CONST uint kHoleBox = 1u;
SHARED_CONST uint kHoleMask = 2u;  // a box whose cross-section is an image

/// Share of the radius over which the edge of a cylinder or box goes from open to closed.
SHARED_CONST float kHoleSoftShare = 0.4f;

/// `forward`, `right` and `up` are unit vectors, each at a right angle to the others.
struct Hole {
  vec3 origin_world;        // [m]
  float radius;             // of the open hole; half the edge of a box or mask [m]
  vec3 forward;             // where the shot goes: local +z
  float distance_to_far;    // depth of the hole [m], > 0
  vec3 right;               // local +x
  float time_start;         // when the shot was fired [s]
  vec3 up;                  // local +y
  float time_to_reach_far;  // the front gets from z = 0 to distance_to_far in this time [s]
  float time_to_expand;     // [s]
  float time_to_stay_open;  // counted from when it is wide open [s]
  float time_to_fade;       // [s]
  uint shape;               // kHoleCylinder, kHoleBox or kHoleMask
  vec2 uv_min, uv_max;      // of the mask in the mask atlas, (0, 0) its first texel's corner; else unused
};
SHARED_SIZE(Hole, 96);

/// How far noise of the amplitude `rim` [m] moves the rim: of narrow holes less, so that they stay what they are.
SHARED_FUNCTION float hole_rim(Hole hole, float rim) { return min(rim, 0.25f * hole.radius); }

/// No point of any shape is farther from the axis than so many radii: the corner of a box whose rim is moved outward.
SHARED_CONST float kHoleWidest = 1.7682f;

/// How open a hole is at a depth, as shares of its radius and of what it removes.
struct HoleOpening {
  float radius;
  float strength;
};
SHARED_SIZE(HoleOpening, 8);

/// `age`: how long it has been opening there [s], above 0; the other times as in Hole.
SHARED_FUNCTION HoleOpening hole_opening(float age, float time_to_expand, float time_to_stay_open, float time_to_fade) {
  float opened = clamp(age / max(time_to_expand, 1e-6f), 0.0f, 1.0f);
  float closing_age = age - time_to_expand - time_to_stay_open;
  float left = 1.0f - clamp(closing_age / max(time_to_fade, 1e-6f), 0.0f, 1.0f);
  HoleOpening opening;
  opening.radius = opened * left;
  opening.strength = left;
  return opening;
}

/// What is removed of the smoke inside the radius of a cylinder or box, 0 at its edge.
SHARED_FUNCTION float hole_edge(float from_axis, float radius) {
  return smoothstep(0.0f, 1.0f, (radius - from_axis) / (radius * kHoleSoftShare));
}

/// Where across a mask a point lies: -1..1 of the radius, the image's first row on top.
SHARED_FUNCTION vec2 hole_mask_share(float x, float y, float radius) {
  return clamp(vec2(0.5f + 0.5f * x / radius, 0.5f - 0.5f * y / radius), vec2(0.0f), vec2(1.0f));
}

/// What a hole does at a point.
struct HoleCut {
  float strength;  // share of the smoke that it removes, [0, 1]; of a mask where its image is white
  vec2 uv;         // where in the mask atlas the image is read; only for masks
};
SHARED_SIZE(HoleCut, 12);

/// `time` is on the clock of Hole::time_start. Nothing is removed before the front has come by, and at depths below 0
/// or above distance_to_far. rim_noise_metres widens (above 0) or narrows the hole at this point.
SHARED_FUNCTION HoleCut hole_cut(Hole hole, vec3 p_world, float time, float rim_noise_metres) {
  HoleCut cut;
  cut.strength = 0.0f;
  cut.uv = hole.uv_min;
  vec3 from_origin = p_world - hole.origin_world;
  float z = dot(from_origin, hole.forward);
  if (z < 0.0f || z > hole.distance_to_far) return cut;

  // How long the hole has been opening at this depth.
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
    cut.uv = mix(hole.uv_min, hole.uv_max, hole_mask_share(x, y, radius));
  } else {
    cut.strength *= hole_edge(from_axis, radius);
  }
  return cut;
}

/// Share of the smoke that the hole removes at a point, in [0, 1]; a mask as if its image were white.
SHARED_FUNCTION float hole_strength(Hole hole, vec3 p_world, float time, float rim_noise_metres) {
  return hole_cut(hole, p_world, time, rim_noise_metres).strength;
}

SHARED_END
#endif
