// Where the smoke's noise is carried: outward while a cloud blooms, around in slow rolls, along with what moves through.
//
//   displacements   per part (the share of a cloud in a brick) 6^3 points, x + 6 (y + 6 z), two voxels apart, the first at the
//            brick's texel (0, 0, 0): two uints of two halves each, growth in metres (sim/growth.hpp) and its weight
//   parts    per slot (first, count) in the list that follows all slots: (part, cloud) each
#ifndef BRUME_DRIFT_H
#define BRUME_DRIFT_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_CONST int kDisplacementPoints = 6;
SHARED_CONST uint kDisplacementsPerBrick = 216u;

/// What a cloud does to the noise in it at a moment.
struct CloudMotion {
  float grown;       // share of its growth that the noise is still to be carried, below 0: has been carried beyond
  float swirl_cos;    // of the angle of its rolls, times how wide they are for the look's roll
  float swirl_sin;
  float front;       // how far its smoke has come [voxels]
  float weight;      // how much it counts where clouds meet, > 0
};
SHARED_SIZE(CloudMotion, 20);

/// Something that moves the noise around a stretch of its way: a shot, a body, an explosion.
struct Impulse {
  vec3 from_world;  // [m]
  float radius;     // nothing is moved farther from the stretch than this [m], > 0
  vec3 to_world;    // [m]
  float outward;    // how far the noise near the stretch is carried away from it [m]
  vec3 along;       // how far it is carried with it [m]
};
SHARED_SIZE(Impulse, 44);

struct NoiseAdvectionParams {
  uint first_slot;  // into the list of slots that the frame needs
  uint slot_count;
  uint all_slots;   // of the volume
  uint impulse_count;
};
SHARED_SIZE(NoiseAdvectionParams, 16);

SHARED_END
#endif
