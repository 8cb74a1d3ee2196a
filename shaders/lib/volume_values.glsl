// Values of the volumes besides the smoke.
#ifndef VOLUME_VALUES_GLSL
#define VOLUME_VALUES_GLSL
#include "lib/brick_rays.glsl"

// Uniform, because most frames have one volume: what is read of volumes[0] is then a constant of the frame.
layout(scalar, binding = kBindVolumes) uniform Volumes { VolumeInstance volumes[kMaxVolumes]; };
layout(scalar, binding = kBindVolumePages) readonly buffer VolumePages { uint volume_pages[]; };
layout(binding = kBindVolumeValues) uniform sampler3D volume_values;

/// As slot_at of the smoke.
uint volume_slot_at(BrickLayout bricks, ivec3 brick, out int empty_edge) {
  empty_edge = kBrickVoxels * kNodeBricks;
  const uint root = root_page(bricks, brick);
  const uint node = root == kNoPage ? 0u : volume_pages[root];
  if (node == 0u) return kNoSlot;
  empty_edge = kBrickVoxels;
  return volume_pages[node_page(bricks, node, brick)] - 1u;
}

/// The value at a point of a brick.
float volume_value(BrickLayout bricks, vec3 brick, uint slot, vec3 p_voxel) {
  const vec3 uvw = (atlas_corner(bricks, slot) + p_voxel - brick * float(kBrickVoxels)) * atlas_texel(bricks);
  return textureLod(volume_values, uvw, 0.0).r;
}

/// The value at a point of a volume's voxel space; 0 outside of its bricks.
float volume_value(BrickLayout bricks, vec3 p_voxel) {
  const vec3 brick = floor(p_voxel / float(kBrickVoxels));
  int empty_edge;
  const uint slot = volume_slot_at(bricks, ivec3(brick), empty_edge);
  return slot == kNoSlot ? 0.0 : volume_value(bricks, brick, slot, p_voxel);
}

#endif
