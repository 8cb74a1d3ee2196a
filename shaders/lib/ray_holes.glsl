// What holes leave of the smoke at the samples of a ray from the eye: each sample asks the holes that its group of pixels
// meets at that distance (shared/open_holes.h).
//
// The includer has `frame` and the constant kHoles, and defines BINDING_HOLES, BINDING_HOLE_LISTS and BINDING_HOLE_MASKS.
#ifndef RAY_HOLES_GLSL
#define RAY_HOLES_GLSL
#include "shared/frame.h"

layout(binding = BINDING_HOLES) readonly buffer Holes { vec4 hole_rows[]; };
layout(scalar, binding = BINDING_HOLE_LISTS) readonly buffer HoleLists { uint hole_lists[]; };
layout(binding = BINDING_HOLE_MASKS) uniform sampler2D hole_masks;
#include "lib/hole_mask.glsl"
#include "lib/hole_rows.glsl"
#include "lib/hole_slabs.glsl"

/// The holes that a ray may meet: the list of its group of pixels.
struct RayHoles {
  uint entries;  // index of the first; their masks come after the last
  uint count;    // or kAskAllHoles
  HoleSlabs slabs;
};

RayHoles holes_of_ray(vec2 position_px) {
  const uvec2 group = uvec2(position_px) / kHoleGroupPixels;
  const uint list = 2u * (group.x + frame.holes.groups_across * group.y);
  if (kHoles == kHolesListed) return RayHoles(hole_lists[list], hole_lists[list + 1u], hole_slabs());
  return RayHoles(0u, kHoles == kHolesAllAsked ? kAskAllHoles : 0u, HoleSlabs(0.0, 0.0));
}

/// Share of the density that a hole leaves at a point; rim_noise: -1 to 1.
float left_by_hole(uint index, vec3 p_world, float rim_noise) {
  // Most are passed by: two of its rows tell.
  const vec4 from_radius = hole_rows[6u * index], forward_far = hole_rows[6u * index + 1u];
  const vec3 apart = p_world - from_radius.xyz;
  const float z = dot(apart, forward_far.xyz), widest = kHoleWidest * from_radius.w;
  const vec3 from_axis = apart - z * forward_far.xyz;
  if (z < 0.0 || z > forward_far.w || dot(from_axis, from_axis) > widest * widest) return 1.0;
  const Hole hole = hole_from_rows(index);
  return 1.0 - hole_strength_masked(hole, p_world, frame.time, rim_noise * hole_rim(hole, frame.look.hole_rim));
}

/// Share of the density that the holes leave at a point of the ray, t metres from the eye; nobody is asked where there
/// is no smoke.
float left_by_holes(RayHoles holes, float t, vec3 p_world, float rim_noise, bool smoke) {
  float left = smoke ? 1.0 : 0.0;
  const bool all = holes.count == kAskAllHoles;
  const uint words = all ? 0u : mask_words(holes.count);
  const uint slab = holes.entries + holes.count + words * slab_at(holes.slabs, t);
  for (uint word = 0u; word < words && left > 0.0; ++word) {
    for (uint bits = hole_lists[slab + word]; bits != 0u && left > 0.0; bits &= bits - 1u)
      left *= left_by_hole(hole_lists[holes.entries + 32u * word + uint(findLSB(bits))] & 0xffffu, p_world, rim_noise);
  }
  for (uint i = 0u; all && i < frame.holes.count && left > 0.0; ++i) left *= left_by_hole(i, p_world, rim_noise);
  return left;
}

#endif
