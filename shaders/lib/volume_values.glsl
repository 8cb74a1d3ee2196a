// Values of the volumes besides the smoke, and their extinction at a point.
#ifndef VOLUME_VALUES_GLSL
#define VOLUME_VALUES_GLSL
#include "lib/brick_rays.glsl"

layout(scalar, binding = kBindVolumes) readonly buffer Volumes { VolumeInstance volumes[]; };
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

/// Extinction of all volumes of the frame at a point [1/m].
float volumes_extinction(uint volume_count, vec3 p_world) {
  float sum = 0.0;
  for (uint i = 0u; i < volume_count; ++i) {
    const vec3 p_voxel = volumes[i].voxel_from_world * vec4(p_world, 1.0);
    if (all(greaterThan(p_voxel, volumes[i].bounds_min)) && all(lessThan(p_voxel, volumes[i].bounds_max)))
      sum += volumes[i].look.extinction * volume_value(volumes[i].bricks, p_voxel);
  }
  return sum;
}

#endif
