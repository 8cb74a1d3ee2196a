// The bricks of volumes besides the smoke: page tables and densities.
#ifndef VOLUME_BRICKS_GLSL
#define VOLUME_BRICKS_GLSL
#include "lib/brick_rays.glsl"

layout(scalar, binding = kBindVolumePages) readonly buffer VolumePages { uint volume_pages[]; };
layout(binding = kBindVolumeDensity) uniform sampler3D volume_density_atlas;

/// The slot of a brick, or kNoSlot; then `empty_edge` is that of the empty cube around it, aligned to it [voxels].
uint volume_slot_at(BrickLayout bricks, ivec3 brick, out int empty_edge) {
  empty_edge = kBrickVoxels * kNodeBricks;
  const uint root = root_page(bricks, brick);
  const uint node = root == kNoPage ? 0u : volume_pages[root];
  if (node == 0u) return kNoSlot;
  empty_edge = kBrickVoxels;
  return volume_pages[node_page(bricks, node, brick)] - 1u;
}

/// Density at a point of a brick, between its voxel centres.
float volume_density(BrickLayout bricks, vec3 brick, uint slot, vec3 p_voxel) {
  const vec3 uvw = (atlas_corner(bricks, slot) + p_voxel - brick * float(kBrickVoxels)) * atlas_texel(bricks);
  return textureLod(volume_density_atlas, uvw, 0.0).r;
}

#endif
