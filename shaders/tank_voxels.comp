// A tank by its painted voxels, with the light that was found for each of them: through lens and glass.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/tank_air.glsl"
#include "lib/tank_glass.glsl"
#include "lib/tank_picture.glsl"
#include "lib/voxel_extinction.glsl"
#include "lib/voxel_walk.glsl"
#include "shared/tank_light.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = kBindVoxelLight) uniform usampler3D voxel_light;

/// Below it nothing behind is visible.
const float kOpaqueTransmittance = 1.0 / 1024.0;
const uint kMostSegments = 64u;

/// Adds what the voxels on a ray up to t_end scatter, and what the fog adds before them; the weight loses what they
/// block.
void march(vec3 origin, vec3 direction, float t_end, bool fog, inout vec3 weight, inout vec3 radiance) {
  VoxelWalk walk = begin_walk(origin, direction, t_end);
  float foggy_to = walk.t;
  while (walk.t < walk.t_end && weight.x > 0.0) {
    const ivec3 at = walk.cell / kSphereBrick;
    if (sphere_bricks[brick_index(at)].count == 0u) {
      step_brick(walk, at, direction);
      continue;
    }
    const uint color = texelFetch(voxel_colors, walk.cell, 0).r;
    const ivec3 cell = walk.cell;
    const float begin = walk.t;
    step_voxel(walk, voxel_leave(walk));
    if (color < 0x01000000u) continue;
    if (fog) {
      const float clear = exp(-tank.air.fog_extinction * (begin - foggy_to));
      radiance += weight * tank.air.fog_color * (1.0 - clear);
      weight *= clear;
      foggy_to = begin;
    }
    const float passed = exp(-voxel_extinction(color) * (min(walk.t, walk.t_end) - begin));
    const vec3 light = unpack_rgb9e5(texelFetch(voxel_light, cell, 0).r);
    radiance += weight * (1.0 - passed) * albedo_of(color) * light;
    weight *= passed;
    if (weight.x < kOpaqueTransmittance) weight = vec3(0.0);
  }
  if (fog && walk.t_end > foggy_to) {
    const float clear = exp(-tank.air.fog_extinction * (walk.t_end - foggy_to));
    radiance += weight * tank.air.fog_color * (1.0 - clear);
    weight *= clear;
  }
}

vec3 ray_radiance(vec3 origin, vec3 direction, inout SampleSource source) {
  vec3 weight = vec3(1.0), radiance = vec3(0.0);
  bool in_glass = is_in_glass(origin);
  for (uint segment = 0u; segment < kMostSegments; ++segment) {
    const float to_glass = distance_to_glass(origin, direction, in_glass);
    march(origin, direction, to_glass, !in_glass && tank.air.fog_extinction > 0.0, weight, radiance);
    if (weight.x == 0.0) return radiance;
    if (to_glass == kNoCrossing) return radiance + weight * backdrop(direction);
    origin += to_glass * direction;
    cross_glass(origin, next_point(source).x, direction, in_glass);
  }
  return radiance;
}

void main() {
  const ivec2 px = sampled_pixel();
  if (any(greaterThanEqual(uvec2(px), tank.size_px))) return;
  vec3 sum = sum_so_far(px);
  for (uint i = 0u; i < samples.count; ++i) {
    SampleSource source = SampleSource(px, samples.first + i, 0u);
    vec3 origin, direction;
    sample_camera(source, origin, direction);
    sum += ray_radiance(origin, direction, source);
  }
  store_sum(px, sum);
}
