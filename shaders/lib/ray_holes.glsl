// Holes along rays from the eye: each sample tests the holes of its tile's cluster (shared/hole_clusters.h).
// The includer defines the constant kHoles.
#ifndef RAY_HOLES_GLSL
#define RAY_HOLES_GLSL
#include "lib/frame.glsl"
#include "lib/hole_remaining.glsl"
#include "lib/hole_slices.glsl"

layout(scalar, binding = kBindHoleLists) readonly buffer HoleLists { uint hole_lists[]; };

/// The holes that a ray may meet: those of its tile.
struct RayHoles {
  uint chunk;  // the tile's word
  HoleSlices slices;
};

RayHoles holes_of_ray(vec2 position_px) {
  const uvec2 tile = uvec2(position_px) / kHoleTilePixels;
  if (kHoles == kHolesClustered)
    return RayHoles(hole_lists[tile.x + frame.holes.tiles_across * tile.y], hole_slices());
  return RayHoles(kHoles == kHolesAllTested ? kTestAllHoles : 0u, HoleSlices(0.0, 0.0));
}

/// Whether a hole may be near a point of the ray, t metres from the eye.
bool any_hole_at(RayHoles holes, float t) {
  if (holes.chunk == 0u || holes.chunk == kTestAllHoles) return holes.chunk != 0u;
  return (holes.chunk & kMoreChunks) != 0u || hole_lists[holes.chunk + slice_at(holes.slices, t)] != 0u;
}

/// Fraction of the density that the holes leave at a point of the ray, t metres from the eye; 0, without any test,
/// where there is no smoke.
float remaining_after_holes(RayHoles holes, float t, vec3 p_world, float rim_noise, bool smoke) {
  float remaining = smoke ? 1.0 : 0.0;
  const float time = frame.time, rim = frame.look.hole_rim;
  const bool all = holes.chunk == kTestAllHoles;
  uint chunk = all ? 0u : holes.chunk & ~kMoreChunks;
  const uint slice = slice_at(holes.slices, t);
  while (chunk != 0u && remaining > 0.0) {
    uint at = hole_lists[chunk + slice];
    for (bool more = at != 0u; more && remaining > 0.0; ++at) {
      // Two at a time: the second is loaded while the first is tested.
      const uint two = hole_lists[at];
      const bool both = (two & kLastInSlice) == 0u;
      const uint i = two & (kLastInSlice - 1u), j = both ? two >> 16u & (kLastInSlice - 1u) : i;
      const HoleFront front_i = hole_front(i), front_j = hole_front(j);
      remaining *= remaining_after_hole(i, front_i, p_world, time, rim_noise, rim);
      if (both) remaining *= remaining_after_hole(j, front_j, p_world, time, rim_noise, rim);
      more = both && (two >> 16u & kLastInSlice) == 0u;
    }
    chunk = (holes.chunk & kMoreChunks) != 0u ? hole_lists[chunk + kHoleSlices] : 0u;
  }
  for (uint i = 0u; all && i < frame.holes.count && remaining > 0.0; ++i)
    remaining *= remaining_after_hole(i, hole_front(i), p_world, time, rim_noise, rim);
  return remaining;
}

#endif
