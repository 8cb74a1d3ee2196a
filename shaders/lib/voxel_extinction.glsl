// What the voxels of a tank block.
#ifndef VOXEL_EXTINCTION_GLSL
#define VOXEL_EXTINCTION_GLSL
#include "shared/tank.h"

layout(binding = kBindVoxelColors) uniform usampler3D voxel_colors;

/// Optical depth of a voxel's length of an opaque voxel: any length of it that counts blocks all light.
const float kOpaqueDepth = 1e6;

/// Optical depth of a voxel's length.
float voxel_extinction(uint color) {
  const uint opacity = color >> 24u;
  return opacity == 255u ? kOpaqueDepth : -log(1.0 - float(opacity) / 255.0);
}

#endif
