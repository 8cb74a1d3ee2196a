// Transmittance along the rays of a light, where they cross the middle of each layer of voxels: a thread per ray.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/voxel_extinction.glsl"
#include "shared/tank_light.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = kBindLightMap, r16f) uniform writeonly image3D light_map;
layout(push_constant, scalar) uniform Params { TankLightParams params; };

void main() {
  const LightMap map = params.map;
  const ivec2 ray = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(uvec2(ray), map.rays))) return;
  const vec2 slope = map.first_slope + vec2(ray) * map.slope_step;
  const vec3 direction = from_map_axes(map.axis, vec3(slope, map.sign)), origin = map.origin;
  const float stretch = length(direction);

  // The part of the ray in the tank, by depth.
  const vec3 inverse = 1.0 / mix(direction, vec3(1e-30), lessThan(abs(direction), vec3(1e-30)));
  const vec3 low = -origin * inverse, high = (vec3(params.size) - origin) * inverse;
  const vec3 enter = min(low, high), leave = max(low, high);
  float depth = max(0.0, max(enter.x, max(enter.y, enter.z)));
  const float end = min(leave.x, min(leave.y, leave.z));
  const ivec3 ahead = ivec3(greaterThanEqual(direction, vec3(0.0)));
  ivec3 cell = clamp(ivec3(floor(origin + direction * depth)), ivec3(0), params.size - 1);

  // Before the tank all light passes; behind it nothing is read.
  float optical_depth = 0.0;
  int layer = 0;
  for (; layer < int(map.layers) && map.first_depth + float(layer) * kMapLayerStep < min(depth, end); ++layer)
    imageStore(light_map, ivec3(ray, layer), vec4(1.0));
  while (depth < end && layer < int(map.layers)) {
    const float extinction = voxel_extinction(texelFetch(voxel_colors, cell, 0).r) * stretch;
    const vec3 planes = (vec3(cell + ahead) - origin) * inverse;
    const float next = min(planes.x, min(planes.y, planes.z)), middle = map.first_depth + float(layer) * kMapLayerStep;
    if (middle <= next) {
      imageStore(light_map, ivec3(ray, layer), vec4(exp(-(optical_depth + extinction * (middle - depth)))));
      ++layer;
    }
    optical_depth += extinction * max(0.0, next - depth);
    depth = next;
    cell += (2 * ahead - 1) * ivec3(lessThanEqual(planes, vec3(next)));
  }
  for (; layer < int(map.layers); ++layer) imageStore(light_map, ivec3(ray, layer), vec4(exp(-optical_depth)));
}
