// Advection of the smoke's noise: outward while a cloud blooms, in slow rolls, and along with whatever moves through.
//
//   displacements   per part (a cloud's smoke in one brick) 6^3 points, x + 6 (y + 6 z), two voxels apart, the first at
//                   the brick's texel (0, 0, 0): four half floats in two uints, growth in metres (smoke/growth.hpp)
//                   and its weight
//   parts           per slot (first, count) into the list behind the slots, whose entries are (part, cloud)
#ifndef BRUME_NOISE_ADVECTION_H
#define BRUME_NOISE_ADVECTION_H
#include "shared/noise_functions.h"
SHARED_BEGIN

SHARED_BINDING(kBindCloudParts, 32u);
SHARED_BINDING(kBindDisplacements, 33u);
SHARED_BINDING(kBindCloudMotions, 34u);
SHARED_BINDING(kBindImpulses, 35u);
SHARED_BINDING(kBindSlots, 36u);

SHARED_CONST int kDisplacementPoints = 6;
SHARED_CONST uint kDisplacementsPerBrick = 216u;
/// Period of the rolls in widths.
SHARED_CONST int kSwirlCells = 64;

/// How a cloud displaces its noise at a time.
struct CloudMotion {
  float grown;       // multiple of the growth that displaces the noise; below 0: inwards
  float swirl_cos;   // of the phase of its rolls, times their amplitude relative to SmokeLook::swirl
  float swirl_sin;
  float front;       // distance that its smoke has reached [voxels]
  float weight;      // where clouds overlap, > 0
};
SHARED_SIZE(CloudMotion, 20);

/// Displacement of the noise around a segment: by a shot, a moving body or an explosion.
struct Impulse {
  vec3 from_world;  // [m]
  float radius;     // no effect farther from the segment [m], > 0
  vec3 to_world;    // [m]
  float outward;    // displacement away from the segment, next to it [m]
  vec3 along;       // displacement along with the moving object [m]
  float padding SHARED_ZERO;
};
SHARED_SIZE(Impulse, 48);

struct NoiseAdvectionParams {
  uint first_slot;  // into the list of slots to update
  uint slot_count;
  uint all_slots;   // of the volume
  uint impulse_count;
};
SHARED_SIZE(NoiseAdvectionParams, 16);

/// The two fields of rolls that the phase of a cloud blends.
SHARED_FUNCTION vec3 swirl_field(vec3 p_world, float swirl_width, uint seed) {
  return curl_noise(p_world / (float(kSwirlCells) * swirl_width), kSwirlCells, seed);
}
SHARED_FUNCTION vec3 first_swirl(vec3 p_world, float swirl_width) { return swirl_field(p_world, swirl_width, 11u); }
SHARED_FUNCTION vec3 second_swirl(vec3 p_world, float swirl_width) { return swirl_field(p_world, swirl_width, 21u); }

/// A part's points around a texel of its brick are those at the eight corners (i & 1, i >> 1 & 1, i >> 2) of a cell:
/// the number of point i,
SHARED_FUNCTION uint growth_point(ivec3 texel, int i) {
  const ivec3 at = (texel >> 1) + ivec3(i & 1, i >> 1 & 1, i >> 2);
  return uint(at.x + kDisplacementPoints * (at.y + kDisplacementPoints * at.z));
}
/// and its share in the texel.
SHARED_FUNCTION float growth_share(ivec3 texel, int i) {
  const vec3 f = 0.5f * vec3(texel & 1);
  const vec3 linear = mix(1.0f - f, f, vec3(ivec3(i & 1, i >> 1 & 1, i >> 2)));
  return linear.x * linear.y * linear.z;
}

/// Displacement of the noise by a cloud, of a growth in xyz and a weight in w, times the cloud's weight, which is in w.
SHARED_FUNCTION vec4 cloud_displacement(CloudMotion motion, vec4 growth, vec3 swirl, float voxel_size) {
  // A cloud moves nothing ahead of its front.
  const float ahead = motion.front - length(vec3(growth)) / voxel_size;
  const float reached = clamp(ahead / max(0.25f * motion.front, 2.0f), 1e-5f, 1.0f);
  return motion.weight * growth.w * reached * vec4(motion.grown * vec3(growth) + swirl, 1.0f);
}

/// From the closest point of an impulse's segment to a point.
SHARED_FUNCTION vec3 from_segment(Impulse impulse, vec3 p_world) {
  const vec3 segment = impulse.to_world - impulse.from_world, from = p_world - impulse.from_world;
  return from - segment * clamp(dot(from, segment) / max(dot(segment, segment), 1e-9f), 0.0f, 1.0f);
}

/// Displacement by an impulse: what it carries along, and away from itself.
SHARED_FUNCTION vec3 impulse_displacement(Impulse impulse, vec3 p_world) {
  const vec3 offset = from_segment(impulse, p_world);
  const float near = max(0.0f, 1.0f - dot(offset, offset) / (impulse.radius * impulse.radius));
  return near * near * (impulse.along + impulse.outward * offset / impulse.radius);
}

SHARED_END
#endif
