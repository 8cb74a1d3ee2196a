// The box of a volume, with object-space positions for interval surfaces.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/raycast.h"

layout(scalar, binding = kBindRaycastVolumes) readonly buffer Raycast { RaycastVolume raycast[]; };
layout(scalar, push_constant) uniform Push { RaycastDraw draw; };

layout(location = 0) out vec3 p_voxel;

// Corners of each face, counter-clockwise from outside: bit 0 of a corner is its x, bit 1 y, bit 2 z.
const int kFaces[24] = int[](0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4, 2, 6, 7, 3, 0, 2, 3, 1, 4, 5, 7, 6);
const int kTriangles[6] = int[](0, 1, 2, 0, 2, 3);

void main() {
  int vertex = gl_VertexIndex % 6;
  if (draw.reversed != 0u) vertex = 5 - vertex;
  const int corner = kFaces[4 * (gl_VertexIndex / 6) + kTriangles[vertex]];
  const vec3 at = vec3(corner & 1, corner >> 1 & 1, corner >> 2);
  p_voxel = mix(raycast[draw.volume].bounds_min, raycast[draw.volume].bounds_max, at);
  gl_Position = raycast[draw.volume].clip_from_voxel * vec4(p_voxel, 1.0);
}
