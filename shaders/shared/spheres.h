// Spheres in a tank of voxels, for C++ and GLSL: which voxels they touch, and the ids that each voxel keeps.
//
// All decisions about ids are made with additions, multiplications and comparisons of floats only, which devices round
// as processors do: a device finds the same ids as the CPU, bit for bit. SPHERES_PRECISE keeps compilers of shaders
// from fusing them; those of C++ have a flag.
#ifndef BRUME_SPHERES_H
#define BRUME_SPHERES_H
#include "shared/shim.h"
#ifdef __cplusplus
#define SPHERES_PRECISE
#else
#define SPHERES_PRECISE precise
#endif
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
  SPHERES_PRECISE vec3 d = max(max(low - center, center - high), vec3(0.0f));
  SPHERES_PRECISE float squared = d.x * d.x + d.y * d.y + d.z * d.z;
  return squared;
}

/// Whether a sphere (xyz: its middle, w: its radius) touches a box; true also where it falls short by rounding.
SHARED_FUNCTION bool sphere_touches(vec4 sphere, vec3 low, vec3 high) {
  SPHERES_PRECISE float reach = sphere.w * sphere.w * kTouchMargin;
  return squared_distance_to_box(vec3(sphere.x, sphere.y, sphere.z), low, high) <= reach;
}

/// What orders the spheres at a point, the nearest first: the power of the point to the sphere, squared distance to
/// the middle minus squared radius. Below 0 inside.
SHARED_FUNCTION float sphere_power(vec4 sphere, vec3 at) {
  SPHERES_PRECISE vec3 d = at - vec3(sphere.x, sphere.y, sphere.z);
  SPHERES_PRECISE float power = d.x * d.x + d.y * d.y + d.z * d.z - sphere.w * sphere.w;
  return power;
}

/// Whether a voxel's cube, `voxel` to `voxel` + 1, is touched by a sphere.
SHARED_FUNCTION bool sphere_touches_voxel(vec4 sphere, ivec3 voxel) {
  vec3 low = vec3(voxel);
  return sphere_touches(sphere, low, low + vec3(1.0f));
}

/// The middle of a voxel, where sphere_power orders its spheres. Exact.
SHARED_FUNCTION vec3 voxel_middle(ivec3 voxel) {
  return vec3(voxel) + vec3(0.5f);
}

/// The nearest spheres of a voxel, of those added so far: kVoxelIds at most, the nearest first, at equal power the one
/// of the lower id. The same for any order in which they are added.
struct NearestIds {
  uvec4 ids;    // 0 behind the last
  vec4 powers;  // ascending; kNoPower behind the last
  uint count;   // of all that were added
};
SHARED_LOCAL(NearestIds);

/// Above the power of any point in a tank.
SHARED_CONST float kNoPower = 3.0e38f;

SHARED_FUNCTION NearestIds nearest_none() {
  NearestIds none;
  none.ids = uvec4(0u);
  none.powers = vec4(kNoPower);
  none.count = 0u;
  return none;
}

/// Whether a sphere goes before another.
SHARED_FUNCTION bool sphere_before(float power, uint id, float other_power, uint other_id) {
  return power < other_power || (power == other_power && id < other_id);
}

/// Adds a sphere that touches the voxel. `id` > 0; each sphere is added once.
SHARED_FUNCTION NearestIds nearest_add(NearestIds n, uint id, float power) {
  // Each of these is true where the one before is.
  bool x = sphere_before(power, id, n.powers.x, n.ids.x), y = sphere_before(power, id, n.powers.y, n.ids.y);
  bool z = sphere_before(power, id, n.powers.z, n.ids.z), w = sphere_before(power, id, n.powers.w, n.ids.w);
  n.ids.w = z ? n.ids.z : (w ? id : n.ids.w);
  n.ids.z = y ? n.ids.y : (z ? id : n.ids.z);
  n.ids.y = x ? n.ids.x : (y ? id : n.ids.y);
  n.ids.x = x ? id : n.ids.x;
  n.powers.w = z ? n.powers.z : (w ? power : n.powers.w);
  n.powers.z = y ? n.powers.y : (z ? power : n.powers.z);
  n.powers.y = x ? n.powers.x : (y ? power : n.powers.y);
  n.powers.x = x ? power : n.powers.x;
  n.count += 1u;
  return n;
}

/// What a voxel stores of them: their ids, or where they are more than kVoxelIds, the marker {0, 1, 0, 0}.
SHARED_FUNCTION uvec4 ids_to_store(NearestIds n) {
  return n.count > kVoxelIds ? uvec4(0u, 1u, 0u, 0u) : n.ids;
}

/// Whether a voxel stores the marker: all spheres of its brick are candidates.
SHARED_FUNCTION bool ids_overflow(uvec4 ids) {
  return ids.x == 0u && ids.y != 0u;
}

/// Most spheres of a tank for which a voxel's ids take two words, the first id in the low half of the first, instead of
/// four words with an id each.
SHARED_CONST uint kMostShortIds = 65535u;

SHARED_FUNCTION uvec2 pack_short_ids(uvec4 ids) {
  return uvec2(ids.x | (ids.y << 16), ids.z | (ids.w << 16));
}

SHARED_FUNCTION uvec4 unpack_short_ids(uvec2 words) {
  return uvec4(words.x & 65535u, words.x >> 16, words.y & 65535u, words.y >> 16);
}

/// Where a ray (direction: unit) crosses a sphere: x where it enters and y where it leaves, which may be behind its
/// origin; y < x: it passes by. The discriminant from the point of the ray nearest to the middle, which keeps its bits
/// where the sphere is small and far away (Haines et al. 2019, "Precision Improvements for Ray/Sphere Intersection").
SHARED_FUNCTION vec2 sphere_chord(vec4 sphere, vec3 origin, vec3 direction) {
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
