// Smoke gathered over the frames of a film.
#ifndef BRUME_ACCUMULATE_H
#define BRUME_ACCUMULATE_H
#include "shared/shim.h"
SHARED_BEGIN

struct AccumulateParams {
  mat4 past_clip_from_world;  // Camera::clip_from_world of the frame before
  uint has_past;              // 0: there is none
};
SHARED_SIZE(AccumulateParams, 68);

/// What a pixel keeps for the next frame besides its smoke.
struct AccumulatedPixel {
  float distance_in_smoke;  // of its surface, along the view axis [m]
  float frames;             // how many its smoke is the mean of, at most kAccumulatedFrames
};
SHARED_SIZE(AccumulatedPixel, 8);

/// Most frames that a pixel's smoke is the mean of.
SHARED_CONST float kAccumulatedFrames = 8.0f;

SHARED_END
#endif
