// The rays of tank_voxels.comp and tank_voxels_over.comp.
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

Seen path_seen(vec3 origin, vec3 direction, float to_surface, inout SampleSource source) {
  vec3 weight = vec3(1.0);
  Seen seen = Seen(vec3(0.0), 0.0);
  bool in_glass = is_in_glass(origin);
  for (uint segment = 0u; segment < kMostSegments; ++segment) {
    const float to_glass = distance_to_glass(origin, direction, in_glass);
    const bool foggy = !in_glass && tank.air.fog_extinction > 0.0;
    march(origin, direction, min(to_glass, to_surface), foggy, weight, seen.radiance);
    if (weight.x == 0.0) return seen;
    if (to_surface <= to_glass) {
      see_behind(direction, weight, seen);
      return seen;
    }
    // Where a bent ray meets the surfaces is unknown.
    to_surface = kNoCrossing;
    origin += to_glass * direction;
    cross_glass(origin, next_point(source).x, direction, in_glass);
  }
  return seen;
}

/// Where the voxels on the ray have blocked half of the light, as if there were no glass.
float first_hit(ivec2 px, vec3 origin, vec3 direction, float to_surface) {
  VoxelWalk walk = begin_walk(origin, direction, to_surface);
  float depth = 0.0;
  while (walk.t < walk.t_end) {
    const ivec3 at = walk.cell / kSphereBrick;
    if (sphere_bricks[brick_index(at)].count == 0u) {
      step_brick(walk, at, direction);
      continue;
    }
    const uint color = texelFetch(voxel_colors, walk.cell, 0).r;
    const float begin = walk.t;
    step_voxel(walk, voxel_leave(walk));
    if (color >= 0x01000000u) depth += voxel_extinction(color) * (min(walk.t, walk.t_end) - begin);
    if (depth > log(2.0)) return begin;
  }
  return kNoCrossing;
}

#include "lib/tank_main.glsl"
