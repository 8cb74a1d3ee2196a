// What holes leave of the smoke at the samples of a ray from the eye: each sample asks the holes that its group of pixels
// meets at that distance (shared/hole_clusters.h).
//
// The includer has `frame` and the constant kHoles, and defines BINDING_HOLES, BINDING_HOLE_LISTS and BINDING_HOLE_MASKS.
#ifndef RAY_HOLES_GLSL
#define RAY_HOLES_GLSL
#include "shared/frame.h"

layout(binding = BINDING_HOLES) readonly buffer Holes { vec4 hole_rows[]; };
layout(scalar, binding = BINDING_HOLE_LISTS) readonly buffer HoleLists { uint hole_lists[]; };
layout(binding = BINDING_HOLE_MASKS) uniform sampler2D hole_masks;
#include "lib/hole_remaining.glsl"
#include "lib/hole_slices.glsl"

/// The holes that a ray may meet: those of its group of pixels.
struct RayHoles {
  uint blocks;  // the group's word
  HoleSlices slices;
};

RayHoles holes_of_ray(vec2 position_px) {
  const uvec2 group = uvec2(position_px) / kHoleTilePixels;
  if (kHoles == kHolesClustered) return RayHoles(hole_lists[group.x + frame.holes.tiles_across * group.y], hole_slices());
  return RayHoles(kHoles == kHolesAllTested ? kTestAllHoles : 0u, HoleSlices(0.0, 0.0));
}

/// Share of the density that the holes leave at a point of the ray, t metres from the eye; nobody is asked where there
/// is no smoke.
float remaining_after_holes(RayHoles holes, float t, vec3 p_world, float rim_noise, bool smoke) {
  float left = smoke ? 1.0 : 0.0;
  const float time = frame.time, rim = frame.look.hole_rim;
  const bool all = holes.blocks == kTestAllHoles;
  uint block = all ? 0u : holes.blocks & ~kMoreChunks;
  const uint slice = slice_at(holes.slices, t);
  while (block != 0u && left > 0.0) {
    uint at = hole_lists[block + slice];
    for (bool more = at != 0u; more && left > 0.0; ++at) {
      // Two at a time: one is fetched while the other is asked.
      const uint two = hole_lists[at];
      const bool both = (two & kLastInSlice) == 0u;
      const uint i = two & (kLastInSlice - 1u), j = both ? two >> 16u & (kLastInSlice - 1u) : i;
      const HoleFront front_i = hole_front(i), front_j = hole_front(j);
      left *= remaining_after_hole(i, front_i, p_world, time, rim_noise, rim);
      if (both) left *= remaining_after_hole(j, front_j, p_world, time, rim_noise, rim);
      more = both && (two >> 16u & kLastInSlice) == 0u;
    }
    block = (holes.blocks & kMoreChunks) != 0u ? hole_lists[block + kHoleSlices] : 0u;
  }
  for (uint i = 0u; all && i < frame.holes.count && left > 0.0; ++i) left *= remaining_after_hole(i, hole_front(i), p_world, time, rim_noise, rim);
  return left;
}

#endif
