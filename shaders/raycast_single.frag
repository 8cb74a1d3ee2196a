// Single-pass raycasting: marches the ray of each fragment of a box between its intersections with the box.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/raycast_march.glsl"

layout(scalar, push_constant) uniform Push { RaycastDraw draw; };
layout(location = 0) out vec4 radiance_transmittance;

void main() {
  const RaycastRay ray = raycast_ray(draw.volume, ivec2(gl_FragCoord.xy));
  radiance_transmittance = raycast_march(draw.volume, ray, intersect_box(draw.volume, ray.voxel));
}
