// Values of the volumes besides the smoke, and their extinction at a point.
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

/// The value at a point of a volume's voxel space; 0 outside of its bricks.
float volume_value(BrickLayout bricks, vec3 p_voxel) {
  const vec3 brick = floor(p_voxel / float(kBrickVoxels));
  int empty_edge;
  const uint slot = volume_slot_at(bricks, ivec3(brick), empty_edge);
  if (slot == kNoSlot) return 0.0;
  const vec3 uvw = (atlas_corner(bricks, slot) + p_voxel - brick * float(kBrickVoxels)) * atlas_texel(bricks);
  return textureLod(volume_values, uvw, 0.0).r;
}

/// Extinction of a volume at a point [1/m].
float volume_extinction(VolumeInstance volume, vec3 p_world) {
  const vec3 p_voxel = volume.voxel_from_world * vec4(p_world, 1.0);
  if (any(lessThan(p_voxel, volume.bounds_min)) || any(greaterThan(p_voxel, volume.bounds_max))) return 0.0;
  return volume.look.extinction * volume_value(volume.bricks, p_voxel);
}

/// Extinction of all volumes of the frame at a point [1/m].
float volumes_extinction(uint volume_count, vec3 p_world) {
  float sum = volume_extinction(volumes[0], p_world);
  for (uint i = 1u; i < volume_count; ++i) sum += volume_extinction(volumes[i], p_world);
  return sum;
}

#endif
