// Walks the voxels of a tank along a ray: after Amanatides & Woo 1987, as shared/dda.h, in bricks and their voxels.
#ifndef VOXEL_WALK_GLSL
#define VOXEL_WALK_GLSL
#include "lib/tank.glsl"

/// A ray in the tank. It has ended when t >= t_end.
struct VoxelWalk {
  vec3 origin, inverse;
  ivec3 ahead;  // 1 for the axes along which it ascends, else 0
  ivec3 cell;
  float t, t_end;
};

VoxelWalk begin_walk(vec3 origin, vec3 direction, float t_end) {
  VoxelWalk walk;
  walk.origin = origin;
  walk.inverse = inverse_of(direction);
  walk.ahead = ivec3(greaterThanEqual(direction, vec3(0.0)));
  const vec2 inside = tank_crossings(origin, walk.inverse);
  walk.t = inside.x;
  walk.t_end = min(inside.y, t_end);
  walk.cell = clamp(ivec3(floor(origin + direction * inside.x)), ivec3(0), tank.size - 1);
  return walk;
}

/// Where the ray leaves its voxel, per axis.
vec3 voxel_leave(VoxelWalk walk) { return (vec3(walk.cell + walk.ahead) - walk.origin) * walk.inverse; }

/// To the next voxel. `leave`: of voxel_leave.
void step_voxel(inout VoxelWalk walk, vec3 leave) {
  walk.t = min(leave.x, min(leave.y, leave.z));
  walk.cell += (2 * walk.ahead - 1) * ivec3(lessThanEqual(leave, vec3(walk.t)));
}

/// To the first voxel behind a brick.
void step_brick(inout VoxelWalk walk, ivec3 brick, vec3 direction) {
  const ivec3 low = brick * kSphereBrick, plane = low + walk.ahead * kSphereBrick;
  const vec3 leave = (vec3(plane) - walk.origin) * walk.inverse;
  walk.t = min(leave.x, min(leave.y, leave.z));
  const ivec3 inside = clamp(ivec3(floor(walk.origin + direction * walk.t)), low, low + (kSphereBrick - 1));
  walk.cell = mix(inside, plane + walk.ahead - 1, lessThanEqual(leave, vec3(walk.t)));
}

#endif
