// Which of the holes of each 8 x 8 pixels may be met in which slab of distance. A thread a slab.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/frame.h"

layout(local_size_x = kHoleSlabs, local_size_y = 2) in;
layout(scalar, binding = 0) readonly buffer Frame { FrameConstants frame; };
layout(binding = 1) readonly buffer Holes { vec4 hole_rows[]; };
layout(scalar, binding = 2) buffer HoleLists { uint hole_lists[]; };
#include "lib/hole_rows.glsl"
#include "lib/hole_slabs.glsl"
#include "lib/ray_cone.glsl"

/// Around what the rays of a group pass in a slab.
RayCone cone_in_slab(uvec2 group, uint slab) {
  const HoleSlabs slabs = hole_slabs();
  const vec2 low_px = vec2(group * kHoleGroupPixels);
  RayCone cone = cone_of_pixels(low_px, low_px + float(kHoleGroupPixels), 0.0);
  // Wider than what rounding may move a sample; and a ray at the cone's rim is not as far along its axis as on its way.
  const float wide = 1.0 / slabs.per_metre, slack = 1e-3 * wide + 1e-4;
  const float from = slabs.begin + float(slab) * wide - slack, to = slabs.begin + float(slab + 1u) * wide + slack;
  const float first = max(from, 0.0) * inversesqrt(1.0 + cone.spread * cone.spread);
  cone.origin_world += first * cone.axis;
  cone.radius = first * cone.spread;
  cone.length_m = to - first;
  return cone;
}

void main() {
  const uint slab = gl_LocalInvocationID.x;
  const uvec2 group = uvec2(gl_WorkGroupID.x, gl_GlobalInvocationID.y);
  if (group.x >= frame.holes.groups_across) return;
  const uint list = 2u * (group.x + frame.holes.groups_across * group.y);
  if (2u * frame.holes.groups_across * (group.y + 1u) > frame.holes.entries_at) return;
  const uint entries = hole_lists[list], count = hole_lists[list + 1u];
  if (count == kAskAllHoles) return;
  const RayCone cone = cone_in_slab(group, slab);
  for (uint word = 0u; word < mask_words(count); ++word) {
    uint bits = 0u;
    for (uint i = 32u * word; i < min(32u * word + 32u, count); ++i) {
      const HoleReach reach = hole_reach(hole_from_rows(hole_lists[entries + i]), frame.time, frame.look.hole_rim);
      if (cone_meets_hole(cone, reach)) bits |= 1u << (i & 31u);
    }
    hole_lists[entries + count + mask_words(count) * slab + word] = bits;
  }
}
