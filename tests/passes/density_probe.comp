// Density of the smoke at given points.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/smoke_density.glsl"

#include "probes.h"

layout(local_size_x = 64) in;
layout(scalar, binding = kBindProbeIn) readonly buffer Points { PackedVec3 points_voxel[]; };
layout(scalar, binding = kBindProbeOut) writeonly buffer Densities { float densities[]; };
layout(scalar, push_constant) uniform Push { VolumeLayout volume; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i < uint(points_voxel.length())) densities[i] = smoke_at(volume, unpacked(points_voxel[i])).density;
}
