// What holes leave of the smoke at the samples of a ray from the eye: each ray asks the holes of its group of pixels.
//
// The includer has `frame`, `noise_tile`, a workgroup of 64 threads and the constant kHoles, and defines BINDING_HOLES,
// BINDING_HOLE_LISTS and BINDING_HOLE_MASKS.
#ifndef RAY_HOLES_GLSL
#define RAY_HOLES_GLSL
#include "shared/frame.h"

layout(binding = BINDING_HOLES) readonly buffer Holes { vec4 hole_rows[]; };
layout(scalar, binding = BINDING_HOLE_LISTS) readonly buffer HoleLists { uint hole_lists[]; };
layout(binding = BINDING_HOLE_MASKS) uniform sampler2D hole_masks;

const bool kLooksAhead = kHoles == kHolesListed;
float hole_noise(vec3 p_world) { return 2.0 * smoke_noise(noise_tile, frame.look, p_world, frame.time).g - 1.0; }
#include "lib/hole_window.glsl"

/// Finds what holes leave at the next kAhead samples, from `begin` on, of a ray through a point of the picture; false
/// when no hole is near: all is left.
bool look_ahead(RaySamples ray, float begin, vec2 position_px) {
  const uvec2 group = uvec2(position_px) / kHoleGroupPixels;
  const uint list = 2u * (group.x + frame.holes.groups_across * group.y);
  const uint first = hole_lists[list], count = hole_lists[list + 1u];
  if (count == 0u) return false;
  begin_ahead();
  for (uint i = 0u; i < min(count, frame.holes.count); ++i) {
    look_ahead(ray, begin, hole_from_rows(count == kAskAllHoles ? i : hole_lists[first + i]));
  }
  return true;
}

/// The plain loop over all holes, which the above is measured against.
float left_by_all_holes(vec3 p_world) {
  float left = 1.0;
  for (uint i = 0u; i < frame.holes.count && left > 0.0; ++i) left *= left_by_hole(hole_from_rows(i), p_world);
  return left;
}

#endif
