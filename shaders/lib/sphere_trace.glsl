// What a ray meets first in a tank of spheres: exact surfaces, and events in the media of those that are not opaque.
#ifndef SPHERE_TRACE_GLSL
#define SPHERE_TRACE_GLSL
#include "lib/tank.glsl"
#include "lib/voxel_walk.glsl"
#include "shared/hash.h"

layout(scalar, binding = kBindSpheres) readonly buffer Spheres { vec4 spheres[]; };
layout(scalar, binding = kBindSphereColors) readonly buffer SphereColors { uint sphere_colors[]; };
layout(scalar, binding = kBindSphereList) readonly buffer SphereList { uint sphere_list[]; };
layout(binding = kBindVoxelIds) uniform usampler3D voxel_ids;

/// Whether ids have 32 bits instead of 16.
layout(constant_id = 1) const bool kWideIds = false;

/// Whether rays try the spheres of each voxel, or without ids those of each brick.
layout(constant_id = 2) const bool kHasIds = true;

/// A ray, and its nearest event so far.
struct SphereRay {
  vec3 origin, direction;  // unit
  uint skip;               // id of the sphere whose surface it leaves, which it cannot meet; 0: none
  uint seed;               // names the ray, for its events in media
  bool any;                // whether any event will do, not the nearest
  float t;                 // of the event
  uint id;                 // of its sphere; 0: none up to t
};

/// The event of a sphere on the ray: where it enters an opaque one, and in a medium a free path behind that. The
/// same at every call for one ray, so that it does not matter in how many voxels the sphere is a candidate.
void meet_sphere(inout SphereRay ray, uint id) {
  if (id == ray.skip) return;
  const vec4 sphere = spheres[id - 1u];
  const vec2 crossed = sphere_chord(sphere, ray.origin, ray.direction);
  if (crossed.y < crossed.x || crossed.y <= 0.0 || crossed.x >= ray.t) return;
  float t = crossed.x;
  if (!kOpaque) {
    const uint color = sphere_colors[id - 1u];
    if (!is_opaque(color)) {
      const float free_path = -log(1.0 - hash3(uvec3(ray.seed, id, 0x51ed270bu)).x) / extinction_of(color);
      t = max(t, 0.0) + free_path;
      if (!(t < crossed.y) || t >= ray.t) return;
    }
  }
  if (t < 0.0) return;
  ray.t = t;
  ray.id = id;
}

void meet_brick(inout SphereRay ray, SphereBrick brick) {
  for (uint i = 0u; i < brick.count; ++i) meet_sphere(ray, sphere_list[brick.first + i] + 1u);
}

void meet_voxel(inout SphereRay ray, ivec3 cell, SphereBrick brick) {
  const uvec4 words = texelFetch(voxel_ids, cell, 0);
  if ((words.x | words.y) == 0u) return;
  const uvec4 ids = kWideIds ? words : unpack_short_ids(words.xy);
  if (ids_overflow(ids)) {
    meet_brick(ray, brick);
    return;
  }
  meet_sphere(ray, ids.x);
  if (ids.y != 0u) meet_sphere(ray, ids.y);
  if (ids.z != 0u) meet_sphere(ray, ids.z);
  if (ids.w != 0u) meet_sphere(ray, ids.w);
}

/// Finds the nearest event before ray.t.
void trace_spheres(inout SphereRay ray) {
  VoxelWalk walk = begin_walk(ray.origin, ray.direction, ray.t);
  while (walk.t < walk.t_end) {
    const ivec3 at = walk.cell / kSphereBrick;
    const SphereBrick brick = sphere_bricks[brick_index(at)];
    if (brick.count == 0u) {
      step_brick(walk, at, ray.direction);
      continue;
    }
    if (!kHasIds) {
      meet_brick(ray, brick);
      step_brick(walk, at, ray.direction);
      if (ray.t <= walk.t || (ray.any && ray.id != 0u)) return;
      continue;
    }
    while (walk.t < walk.t_end && walk.cell / kSphereBrick == at) {
      meet_voxel(ray, walk.cell, brick);
      step_voxel(walk, voxel_leave(walk));
      // An event in the voxels behind counts only if none in between is nearer.
      if (ray.t <= walk.t || (ray.any && ray.id != 0u)) return;
    }
  }
}

#endif
