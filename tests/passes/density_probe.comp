// Density of the smoke at given points.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define BINDING_PAGES 1
#define BINDING_DENSITY 2
#define BINDING_CELLS 3
#define BINDING_BOUNDARY 4
#define BINDING_CORNERS 5
#include "lib/smoke_density.glsl"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Points { vec3 points_voxel[]; };
layout(scalar, binding = 6) writeonly buffer Densities { float densities[]; };
layout(push_constant, scalar) uniform Impulse { VolumeLayout volume; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i < uint(points_voxel.length())) densities[i] = smoke_at(volume, points_voxel[i]).density;
}
