// Rays through voxels that are kept in bricks of 8^3: those of the level, or those of the smoke. Nothing in a brick that is
// not there, which is one step (the same walk as voxel::first_solid).
//
// The includer has `params`, kView, lib/smoke_bricks.glsl and `frame`, and defines BINDING_LEVEL and BINDING_WAYS.
#ifndef VOXEL_RAYS_GLSL
#define VOXEL_RAYS_GLSL
#include "shared/dda.h"
#include "shared/debug_view.h"
#include "shared/frame.h"

// The level as voxel::BitGrid has it: the root, nodes of 8^3 entries, bricks of 16 words. An entry is where in the words what
// it stands for begins, or 0. Bit x + 8 (y & 3) of word 2 z + (y >> 2).
layout(scalar, binding = BINDING_LEVEL) readonly buffer Level { uint level_words[]; };
// Per slot an entry a voxel, x + 8 (y + 8 z), as shared/debug_view.h says.
layout(scalar, binding = BINDING_WAYS) readonly buffer Ways { uint ways[]; };

const uint kNoBrick = 0xffffffffu;

uint level_brick(ivec3 brick) {
  const ivec3 n = brick >> 3, b = brick & 7;
  const uint node = level_words[n.x + params.root_size.x * (n.y + params.root_size.y * n.z)];
  const uint words = node == 0u ? 0u : level_words[node + uint(b.x + 8 * (b.y + 8 * b.z))];
  return words == 0u ? kNoBrick : words;
}

uint smoke_brick(ivec3 brick) {
  int empty_edge;
  return slot_at(frame.volume, brick, empty_edge);
}

/// A brick of what the view shows, or kNoBrick.
uint brick_at(ivec3 brick) { return kView == kViewDistance ? smoke_brick(brick) : level_brick(brick); }

/// 0 where there is none; of the level's voxels 1, of the smoke's their way.
uint voxel_of(uint brick, ivec3 voxel) {
  const ivec3 v = voxel & 7;
  if (kView == kViewDistance) return ways[512u * brick + uint(v.x + 8 * (v.y + 8 * v.z))];
  return level_words[brick + uint(2 * v.z + (v.y >> 2))] >> uint(v.x + 8 * (v.y & 3)) & 1u;
}

uint voxel_at(ivec3 voxel) {
  if (any(lessThan(voxel, ivec3(0))) || any(greaterThanEqual(voxel, params.grid_size))) return 0u;
  const uint brick = brick_at(voxel >> 3);
  return brick == kNoBrick ? 0u : voxel_of(brick, voxel);
}

struct VoxelHit {
  uint what;  // voxel_of, 0: nothing was hit
  ivec3 voxel;
  float t;
  ivec3 normal;  // of the face entered; 0 where the ray begins in the voxel
};

/// The normal of the face that a step went through: of the first axis at an edge.
ivec3 entered_face(Dda d, ivec3 crossed) {
  const ivec3 first = ivec3(crossed.x, crossed.y * (1 - crossed.x), crossed.z * (1 - max(crossed.x, crossed.y)));
  return -d.stride * first;
}

/// The first voxel on a ray for t in [t_begin, t_end), all in voxels.
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
      while (d.t < d.t_end && hit.what == 0u) {
        hit = VoxelHit(voxel_of(brick, d.cell), d.cell, d.t, entered_face(d, faces));
        d = dda_step(d);
        faces = d.crossed;
      }
      if (hit.what != 0u) return hit;
    }
    outer = dda_step(outer);
  }
  hit.what = 0u;
  return hit;
}

#endif
