// Temporal antialiasing of the whole picture.
#ifndef BRUME_ANTIALIAS_H
#define BRUME_ANTIALIAS_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindPastRadiance, 92u);
SHARED_BINDING(kBindMeanRadiance, 93u);

struct AntialiasParams {
  mat4 past_clip_from_world;  // of the previous frame, without its jitter
  vec2 jitter;                // from the middle of each pixel to the point that this frame shows, y down [px]
  uint has_past;              // 0: there is no previous frame
};
SHARED_SIZE(AntialiasParams, 76);

/// Upper limits of the frames whose mean a pixel is: at rest twice as many as there are jitter positions, so that the
/// mean hardly follows them; where the image moves by a pixel or more from frame to frame few, so that it stays sharp.
SHARED_CONST float kAntialiasedFrames = 16.0f;
SHARED_CONST float kAntialiasedFramesInMotion = 5.0f;

SHARED_END
#endif
