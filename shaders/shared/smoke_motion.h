// Where the smoke of each pixel was in the frame before, for a host's upscaler.
#ifndef BRUME_SMOKE_MOTION_H
#define BRUME_SMOKE_MOTION_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindSmokeMotion, 120u);
SHARED_BINDING(kBindMotionEntries, 121u);

/// The distance where there is no smoke [m]: the largest half float. Drivers may store infinity as no number.
SHARED_CONST float kNoSmoke = 65504.0f;

struct SmokeMotionParams {
  mat4 past_from_world;  // planning::PastView of the previous frame, without jitter
  vec2 jitter_px;        // from the middle of each pixel to the point that it shows, y down
  uint has_past;         // 0: there is no previous frame
};
SHARED_SIZE(SmokeMotionParams, 76);

SHARED_END
#endif
