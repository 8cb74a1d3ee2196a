// Rays through voxels in bricks of 8^3: those of the level, or those of the smoke. An absent brick is one step, as in
// voxel::first_solid. The includer has `params` and the constant kView.
#ifndef VOXEL_RAYS_GLSL
#define VOXEL_RAYS_GLSL
#include "lib/bricks.glsl"
#include "lib/frame.glsl"
#include "shared/dda.h"
#include "shared/debug_view.h"

// The level as in voxel::BitGrid: the root, nodes of 8^3 entries, bricks of 16 words. An entry is the index of the
// first word of its node or brick, or 0. Bit x + 8 (y & 3) of word 2 z + (y >> 2) of a brick.
layout(scalar, binding = kBindLevelWords) readonly buffer Level { uint level_words[]; };
// Per slot a distance entry per voxel (shared/debug_view.h), x + 8 (y + 8 z).
layout(scalar, binding = kBindDistances) readonly buffer Distances { uint distances[]; };

const uint kNoBrick = 0xffffffffu;

uint level_brick(ivec3 brick) {
  const ivec3 n = brick >> 3, b = brick & 7;
  const uint node = level_words[n.x + params.root_size.x * (n.y + params.root_size.y * n.z)];
  const uint words = node == 0u ? 0u : level_words[node + uint(b.x + 8 * (b.y + 8 * b.z))];
  return words == 0u ? kNoBrick : words;
}

uint smoke_brick(ivec3 brick) {
  int empty_edge;
  return slot_at(frame.smoke.bricks, brick, empty_edge);
}

/// A brick of the voxels that the view shows, or kNoBrick.
uint brick_at(ivec3 brick) { return kView == kViewDistance ? smoke_brick(brick) : level_brick(brick); }

/// Value of a voxel: 0 if absent, 1 in the level, its distance entry in the smoke.
uint voxel_of(uint brick, ivec3 voxel) {
  const ivec3 v = voxel & 7;
  if (kView == kViewDistance) return distances[512u * brick + uint(v.x + 8 * (v.y + 8 * v.z))];
  return level_words[brick + uint(2 * v.z + (v.y >> 2))] >> uint(v.x + 8 * (v.y & 3)) & 1u;
}

uint voxel_at(ivec3 voxel) {
  if (any(lessThan(voxel, ivec3(0))) || any(greaterThanEqual(voxel, params.grid_size))) return 0u;
  const uint brick = brick_at(voxel >> 3);
  return brick == kNoBrick ? 0u : voxel_of(brick, voxel);
}

struct VoxelHit {
  uint value;  // voxel_of; 0: no hit
  ivec3 voxel;
  float t;
  ivec3 normal;  // of the face entered; 0 where the ray starts inside the voxel
};

/// Normal of the face that a step crossed; at an edge, of its first axis.
ivec3 entered_face(Dda d, ivec3 crossed) {
  const ivec3 first = ivec3(crossed.x, crossed.y * (1 - crossed.x), crossed.z * (1 - max(crossed.x, crossed.y)));
  return -d.stride * first;
}

/// The first voxel on a ray for t in [t_begin, t_end) voxels.
VoxelHit first_voxel(vec3 origin, vec3 direction, float t_begin, float t_end) {
  VoxelHit hit = VoxelHit(0u, ivec3(0), t_end, ivec3(0));
  Dda outer = dda_begin(origin, direction, ivec3(0), params.grid_size, 1, t_begin, t_end);
  if (outer.t >= outer.t_end) return hit;
  const ivec3 crossed = outer.crossed;
  outer = dda_begin(origin, direction, ivec3(0), (params.grid_size + 7) / 8, 8, outer.t, outer.t_end);
  outer.crossed = crossed;
  while (outer.t < outer.t_end) {
    const uint brick = brick_at(outer.cell);
    if (brick != kNoBrick) {
      const ivec3 low = outer.cell * 8;
      Dda d = dda_begin(origin, direction, low, min(low + 8, params.grid_size), 1, outer.t, outer.t_end);
      ivec3 faces = outer.crossed;
      while (d.t < d.t_end && hit.value == 0u) {
        hit = VoxelHit(voxel_of(brick, d.cell), d.cell, d.t, entered_face(d, faces));
        d = dda_step(d);
        faces = d.crossed;
      }
      if (hit.value != 0u) return hit;
    }
    outer = dda_step(outer);
  }
  hit.value = 0u;
  return hit;
}

#endif
