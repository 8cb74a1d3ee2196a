// What one hole leaves of the smoke: hole_strength_masked, from no more rows than it takes. Needs what lib/hole_rows.glsl
// and lib/hole_mask.glsl need.
#ifndef HOLE_LEFT_GLSL
#define HOLE_LEFT_GLSL
#include "lib/hole_mask.glsl"
#include "lib/hole_rows.glsl"

/// The rows of a hole that are always needed.
struct HoleFront {
  vec4 a, b;
};
HoleFront hole_front(uint index) { return HoleFront(hole_rows[6u * index], hole_rows[6u * index + 1u]); }

/// Share of the density that a hole leaves at a point; rim_noise: -1 to 1, of at most `rim` metres.
float remaining_after_hole(uint index, HoleFront front, vec3 p_world, float time, float rim_noise, float rim) {
  const vec4 a = front.a, b = front.b;
  const bool is_round = b.w < 0.0;
  const vec3 apart = p_world - a.xyz;
  const float z = dot(apart, b.xyz), full = abs(a.w), far = abs(b.w);
  const vec3 across = apart - z * b.xyz;
  const float apart2 = dot(across, across);
  float radius = full + rim_noise * min(rim, 0.25 * full);  // hole_rim
  if (z < 0.0 || z > far || apart2 >= radius * radius * (is_round ? 1.0 : 2.0001)) return 1.0;

  float strength = 1.0;
  uint shape = is_round ? kHoleCylinder : kHoleBox;
  if (a.w < 0.0) {
    const vec4 e = hole_rows[6u * index + 4u];
    shape = floatBitsToUint(e.w);
    const float age = time - hole_rows[6u * index + 2u].w - z / max(far, 1e-6) * hole_rows[6u * index + 3u].w;
    const HoleOpening opening = hole_opening(age, e.x, e.y, e.z);
    strength = age > 0.0 ? opening.strength : 0.0;
    radius *= opening.radius;
  }
  float x = sqrt(apart2), y = 0.0;
  if (!is_round) {
    x = dot(apart, hole_rows[6u * index + 2u].xyz);
    y = dot(apart, hole_rows[6u * index + 3u].xyz);
  }
  const float from_axis = max(abs(x), abs(y));
  if (strength <= 0.0 || from_axis >= radius) return 1.0;
  if (shape != kHoleMask) return 1.0 - strength * hole_edge(from_axis, radius);
  const vec4 uv = hole_rows[6u * index + 5u];
  return 1.0 - strength * mask_at(mix(uv.xy, uv.zw, hole_mask_share(x, y, radius)));
}

#endif
