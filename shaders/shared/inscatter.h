// The light pass: what every texel of the smoke's bricks receives from the lamps.
#ifndef BRUME_INSCATTER_H
#define BRUME_INSCATTER_H
#include "shared/shim.h"
SHARED_BEGIN

struct InscatterParams {
  uint first_slot;
  uint slot_count;
  uint volume_steps;  // most steps through the smoke towards a light
};
SHARED_SIZE(InscatterParams, 12);

SHARED_END
#endif
