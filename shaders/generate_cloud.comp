// Evaluates a shape of fog in bricks of 8^3 voxels.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/cloud.h"

layout(local_size_x = 64) in;
layout(scalar, binding = kBindCloudBricks) readonly buffer Bricks { PackedIvec3 first_voxels[]; };
layout(scalar, binding = kBindCloudValues) writeonly buffer Values { float values[]; };
layout(scalar, push_constant) uniform Push { CloudParams params; };

void main() {
  const uint brick = gl_GlobalInvocationID.x >> 9u, voxel = gl_GlobalInvocationID.x & 511u;
  if (brick >= params.brick_count) return;
  const ivec3 in_brick = ivec3(voxel & 7u, (voxel >> 3u) & 7u, voxel >> 6u);
  values[gl_GlobalInvocationID.x] = cloud_voxel(params, unpacked(first_voxels[brick]) + in_brick);
}
