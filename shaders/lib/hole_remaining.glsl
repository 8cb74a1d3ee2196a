// The fraction of the smoke that one hole leaves: hole_strength_masked from as few rows of the packed hole as it takes.
#ifndef HOLE_REMAINING_GLSL
#define HOLE_REMAINING_GLSL
#include "lib/hole_mask.glsl"
#include "lib/packed_holes.glsl"

/// The two rows that are always read, so that callers can load them early.
struct HoleFront {
  vec4 origin_radius, forward_far;
};
HoleFront hole_front(uint index) {
  return HoleFront(packed_holes[index].origin_radius, packed_holes[index].forward_far);
}

/// Fraction of the density that a hole leaves at a point. rim_noise: -1 to 1, scaled to at most `rim` metres.
float remaining_after_hole(uint index, HoleFront front, vec3 p_world, float time, float rim_noise, float rim) {
  // Outside of its widest cross-section?
  const bool is_round = hole_is_round(front.forward_far);
  const vec3 forward = front.forward_far.xyz, from_origin = p_world - front.origin_radius.xyz;
  const float z = dot(from_origin, forward);
  const float full = hole_number(front.origin_radius.w), far = hole_number(front.forward_far.w);
  const vec3 across = from_origin - z * forward;
  const float across2 = dot(across, across);
  float radius = full + rim_noise * min(rim, 0.25 * full);  // hole_rim
  if (z < 0.0 || z > far || across2 >= radius * radius * (is_round ? 1.0 : 2.0001)) return 1.0;

  // Opening at this depth.
  float strength = 1.0;
  uint shape = is_round ? kHoleCylinder : kHoleBox;
  if (hole_is_partial(front.origin_radius)) {
    const uvec4 times_shape = packed_holes[index].times_shape;
    const vec3 times = uintBitsToFloat(times_shape.xyz);
    shape = times_shape.w;
    const float time_start = packed_holes[index].right_start.w, time_to_reach_far = packed_holes[index].up_reach.w;
    const float age = time - time_start - z / max(far, 1e-6) * time_to_reach_far;
    const HoleOpening opening = hole_opening(age, times.x, times.y, times.z);
    strength = age > 0.0 ? opening.strength : 0.0;
    radius *= opening.radius;
  }

  // Position in the cross-section.
  float x = sqrt(across2), y = 0.0;
  if (!is_round) {
    x = dot(from_origin, packed_holes[index].right_start.xyz);
    y = dot(from_origin, packed_holes[index].up_reach.xyz);
  }
  const float from_axis = max(abs(x), abs(y));
  if (strength <= 0.0 || from_axis >= radius) return 1.0;
  if (shape != kHoleMask) return 1.0 - strength * hole_edge(from_axis, radius);
  const vec4 uv = packed_holes[index].uv;
  return 1.0 - strength * mask_at(mix(uv.xy, uv.zw, hole_mask_position(x, y, radius)));
}

#endif
