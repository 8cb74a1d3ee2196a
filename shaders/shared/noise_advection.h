// Advection of the smoke's noise: outward while a cloud blooms, in slow rolls, and along with whatever moves through.
//
//   displacements   per part (a cloud's smoke in one brick) 6^3 points, x + 6 (y + 6 z), two voxels apart, the first at
//                   the brick's texel (0, 0, 0): four half floats in two uints, growth in metres (smoke/growth.hpp)
//                   and its weight
//   parts           per slot (first, count) into the list behind the slots, whose entries are (part, cloud)
#ifndef BRUME_NOISE_ADVECTION_H
#define BRUME_NOISE_ADVECTION_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindCloudParts, 32u);
SHARED_BINDING(kBindDisplacements, 33u);
SHARED_BINDING(kBindCloudMotions, 34u);
SHARED_BINDING(kBindImpulses, 35u);
SHARED_BINDING(kBindSlots, 36u);

SHARED_CONST int kDisplacementPoints = 6;
SHARED_CONST uint kDisplacementsPerBrick = 216u;

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
};
SHARED_SIZE(Impulse, 44);

struct NoiseAdvectionParams {
  uint first_slot;  // into the list of slots to update
  uint slot_count;
  uint all_slots;   // of the volume
  uint impulse_count;
};
SHARED_SIZE(NoiseAdvectionParams, 16);

SHARED_END
#endif
