// Values of the volumes besides the smoke.
#ifndef VOLUME_VALUES_GLSL
#define VOLUME_VALUES_GLSL
#include "lib/brick_rays.glsl"

// Uniform, because most frames have one volume: what is read of volumes[0] is then a constant of the frame.
layout(scalar, binding = kBindVolumes) uniform Volumes { VolumeInstance volumes[kMaxVolumes]; };
layout(scalar, binding = kBindVolumePages) readonly buffer VolumePages { uint volume_pages[]; };
layout(binding = kBindVolumeValues) uniform sampler3D volume_values;

BrickAt volume_brick(BrickLayout bricks, vec3 p_voxel) {
  const ivec3 brick = ivec3(floor(p_voxel / float(kBrickVoxels)));
  const uint page = root_page(bricks, brick);
  const uint root = page == kNoPage ? 0u : volume_pages[page];
  if (root < kFirstNode) return empty_nodes(brick, root);
  const uint entry = volume_pages[node_page(bricks, root, brick)];
  const bool is_uniform = (entry & kUniformBrick) != 0u;
  return BrickAt(vec3(brick * kBrickVoxels), float(kBrickVoxels), is_uniform ? kUniformSlot : entry - 1u,
                 unpackHalf2x16(entry).x);
}

/// The value at a point of a brick, which is not empty.
float volume_value(BrickLayout bricks, BrickAt brick, vec3 p_voxel) {
  if (brick.slot == kUniformSlot) return brick.uniform_value;
  const vec3 uvw = (atlas_corner(bricks, brick.slot) + p_voxel - brick.low) * bricks.atlas_texel;
  return textureLod(volume_values, uvw, 0.0).r;
}

/// The value at a point of a volume's voxel space; 0 outside of its bricks.
float volume_value(BrickLayout bricks, vec3 p_voxel) {
  const BrickAt brick = volume_brick(bricks, p_voxel);
  return brick.slot == kNoSlot ? 0.0 : volume_value(bricks, brick, p_voxel);
}

#endif
