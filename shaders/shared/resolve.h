// The march at a reduced resolution: one ray for a block of march_scale x march_scale pixels.
#ifndef BRUME_RESOLVE_H
#define BRUME_RESOLVE_H
#include "shared/shim.h"
SHARED_BEGIN

/// Whose rays the march follows.
SHARED_CONST uint kRaysOfPixels = 0u;
SHARED_CONST uint kRaysOfTiles = 1u;
SHARED_CONST uint kRaysOfList = 2u;

/// What the march counts: nothing; the samples of textures, all together; these and each ray's steps.
SHARED_CONST uint kCountNothing = 0u;
SHARED_CONST uint kCountSamples = 1u;
SHARED_CONST uint kCountSteps = 2u;

/// Where the ray of a block runs, and where the surfaces of the block's pixels lie [m along the view axis]. They fall
/// into two groups at the middle of near and far:
///
///   near --- near_last            far_first --- far
///
/// In a block of one even surface near_last = far and far_first = near: the groups overlap. Distances stop at the end
/// of the smoke.
struct RayEnds {
  vec2 position_px;  // of the ray: the middle of the block, or a far pixel where one surface stands before another
  float near, near_last, far_first, far;
};
SHARED_SIZE(RayEnds, 24);

/// How much of the list's blocks there is: what the march over their pixels is dispatched with.
struct MarchList {
  uvec3 groups;  // of 64 pixels; x and y begin at 0, z is 1
  uint count;    // of blocks
};
SHARED_SIZE(MarchList, 16);

/// Groups in a row of that dispatch.
SHARED_CONST uint kListedRow = 1024u;

/// How far off a ray's transmittance may be at a pixel's depth for it to count in full among its neighbours.
SHARED_CONST float kDoubt = 0.008f;

/// How far off it may be for the rays of neighbours to be compared at that depth.
SHARED_CONST float kKnown = 0.05f;

/// FrameConstants::resolve_error of a picture that hides what the full one does.
SHARED_CONST float kResolveError = 3.0f / 255.0f;

/// Radiance times exposure of a surface in bright light.
SHARED_CONST float kBrightSurface = 0.3f;

/// Blocks per axis.
SHARED_FUNCTION uvec2 blocks_of(uvec2 size_px, uint march_scale) {
  return (size_px + march_scale - 1u) / march_scale;
}

SHARED_END
#endif
