// Temporal accumulation of the marched smoke.
#ifndef BRUME_ACCUMULATE_H
#define BRUME_ACCUMULATE_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindPastSmoke, 38u);
SHARED_BINDING(kBindPastPixels, 39u);
SHARED_BINDING(kBindMeanSmoke, 40u);
SHARED_BINDING(kBindMeanPixels, 41u);

struct AccumulateParams {
  mat4 past_from_world;  // planning::PastView of the previous frame
  uvec2 past_size_px;    // its size, which may be another one
  uint has_past;         // 0: there is no previous frame
};
SHARED_SIZE(AccumulateParams, 76);

/// What a pixel stores for the next frame besides its smoke.
struct AccumulatedPixel {
  float distance_in_smoke;  // to its surface along the view axis, clamped to the smoke [m]
  float frames;             // whose mean its smoke is, at most kAccumulatedFrames
};
SHARED_SIZE(AccumulatedPixel, 8);

/// Upper limit of AccumulatedPixel::frames.
SHARED_CONST float kAccumulatedFrames = 8.0f;

SHARED_END
#endif
