// Spheres in a tank of voxels, for C++ and GLSL: which voxels they touch, and the ids that each voxel keeps.
//
// All decisions are made with additions and multiplications of floats only, which devices round as processors do: a
// device finds the same ids as the CPU, bit for bit. Shaders declare the results `precise`, so that none is fused.
#ifndef BRUME_SPHERES_H
#define BRUME_SPHERES_H
#include "shared/shim.h"
SHARED_BEGIN

/// Edge of a brick of a tank [voxels].
SHARED_CONST int kSphereBrick = 8;

/// Ids that a voxel stores; where more spheres touch it, all of its brick's are candidates.
SHARED_CONST uint kVoxelIds = 4u;

/// Which spheres touch a brick: `count` indices from `first` on in the list of all bricks.
struct SphereBrick {
  uint first;
  uint count;
};
SHARED_SIZE(SphereBrick, 8);

/// Factor of the squared radius in sphere_touches: more than the rounding of the squared distance leaves out, so that
/// no sphere that touches is missed.
SHARED_CONST float kTouchMargin = 1.0f + 1.0f / 65536.0f;

/// Squared distance of a sphere's middle to a box; 0 inside.
SHARED_FUNCTION float squared_distance_to_box(vec3 center, vec3 low, vec3 high) {
  vec3 d = max(max(low - center, center - high), vec3(0.0f));
  return d.x * d.x + d.y * d.y + d.z * d.z;
}

/// Whether a sphere (xyz: its middle, w: its radius) touches a box; true also where it falls short by rounding.
SHARED_FUNCTION bool sphere_touches(vec4 sphere, vec3 low, vec3 high) {
  return squared_distance_to_box(vec3(sphere.x, sphere.y, sphere.z), low, high) <=
         sphere.w * sphere.w * kTouchMargin;
}

/// What orders the spheres at a point, the nearest first: the power of the point to the sphere, squared distance to
/// the middle minus squared radius. Below 0 inside.
SHARED_FUNCTION float sphere_power(vec4 sphere, vec3 at) {
  vec3 d = at - vec3(sphere.x, sphere.y, sphere.z);
  return d.x * d.x + d.y * d.y + d.z * d.z - sphere.w * sphere.w;
}

/// Where a ray (direction: unit) crosses a sphere: x where it enters and y where it leaves, which may be behind its
/// origin; y < x: it passes by. The discriminant from the point of the ray nearest to the middle, which keeps its bits
/// where the sphere is small and far away (Haines et al. 2019, "Precision Improvements for Ray/Sphere Intersection").
SHARED_FUNCTION vec2 sphere_crossings(vec4 sphere, vec3 origin, vec3 direction) {
  vec3 apart = origin - vec3(sphere.x, sphere.y, sphere.z);
  float nearest = -dot(apart, direction);
  vec3 across = apart + nearest * direction;
  float rest = sphere.w * sphere.w - dot(across, across);
  if (rest < 0.0f) return vec2(1.0f, 0.0f);
  float half_chord = sqrt(rest);
  return vec2(nearest - half_chord, nearest + half_chord);
}

SHARED_END
#endif
