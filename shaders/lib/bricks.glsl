// Sparse bricks of a volume: page table and positions in the atlas (shared/smoke_volume.h).
#ifndef BRICKS_GLSL
#define BRICKS_GLSL
#include "shared/smoke_volume.h"

layout(scalar, binding = kBindPages) readonly buffer Pages { uint pages[]; };

const uint kNoSlot = 0xffffffffu;

/// The slot of a brick, or kNoSlot where the volume is empty; then `empty_edge` is the edge [voxels] of the aligned
/// empty cube around the brick.
uint slot_at(VolumeLayout volume, ivec3 brick, out int empty_edge) {
  empty_edge = kBrickVoxels * kNodeBricks;
  const ivec3 n = (brick >> 3) - volume.window_origin, size = volume.window_size;
  if (any(lessThan(n, ivec3(0))) || any(greaterThanEqual(n, size))) return kNoSlot;
  const uint node = pages[n.x + size.x * (n.y + size.y * n.z)];
  if (node == 0u) return kNoSlot;
  empty_edge = kBrickVoxels;
  const ivec3 b = brick & (kNodeBricks - 1);
  const uint first = uint(size.x * size.y * size.z) + (node - 1u) * kPageEntries;
  return pages[first + uint(b.x + kNodeBricks * (b.y + kNodeBricks * b.z))] - 1u;
}

/// Low corner of a brick's voxels in the atlas [texels].
vec3 atlas_corner(VolumeLayout volume, uint slot) { return vec3(atlas_first_texel(volume.atlas_bricks, slot)) + 1.0; }

/// Size of a texel of the atlas in texture coordinates.
vec3 atlas_texel(VolumeLayout volume) { return 1.0 / vec3(volume.atlas_bricks * kBrickTexels); }

#endif
