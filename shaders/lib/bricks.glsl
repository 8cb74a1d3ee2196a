// The smoke's bricks: page table, and positions in the atlas (shared/volume.h).
#ifndef BRICKS_GLSL
#define BRICKS_GLSL
#include "lib/brick_rays.glsl"
#include "shared/smoke_volume.h"

layout(scalar, binding = kBindPages) readonly buffer Pages { uint pages[]; };

/// The slot of a brick, or kNoSlot where there is no smoke; then `empty_edge` is the edge [voxels] of the aligned empty
/// cube around the brick.
uint slot_at(BrickLayout bricks, ivec3 brick, out int empty_edge) {
  empty_edge = kBrickVoxels * kNodeBricks;
  const uint root = root_page(bricks, brick);
  const uint node = root == kNoPage ? 0u : pages[root];
  if (node < kFirstNode) return kNoSlot;
  empty_edge = kBrickVoxels;
  return pages[node_page(bricks, node, brick)] - 1u;
}

#endif
