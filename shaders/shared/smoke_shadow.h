// Smoke between a light and the surfaces that it reaches.
#ifndef BRUME_SMOKE_SHADOW_H
#define BRUME_SMOKE_SHADOW_H
#include "shared/shim.h"
SHARED_BEGIN

struct SmokeShadowParams {
  uint light;       // index of the light
  uint size;        // texels per edge of a layer
  float max_steps;  // through the smoke
};
SHARED_SIZE(SmokeShadowParams, 12);

SHARED_END
#endif
