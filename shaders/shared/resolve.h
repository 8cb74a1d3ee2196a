// The march at a reduced resolution: one ray for a tile of march_scale x march_scale pixels.
#ifndef BRUME_RESOLVE_H
#define BRUME_RESOLVE_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindRayEnds, 32u);
SHARED_BINDING(kBindMarchList, 33u);
SHARED_BINDING(kBindSmokeNear, 34u);
SHARED_BINDING(kBindSmokeFar, 35u);
SHARED_BINDING(kBindSmoke, 36u);
SHARED_BINDING(kBindMarchCounters, 37u);

/// Rays that the march follows: one per pixel, one per tile, or one per pixel of the listed tiles.
SHARED_CONST uint kRaysOfPixels = 0u;
SHARED_CONST uint kRaysOfTiles = 1u;
SHARED_CONST uint kRaysOfList = 2u;

/// What the march records besides its images: nothing; all texture samples; texture samples and the steps of each ray;
/// where each ray enters the media.
SHARED_CONST uint kCountNothing = 0u;
SHARED_CONST uint kCountSamples = 1u;
SHARED_CONST uint kCountSteps = 2u;
SHARED_CONST uint kCountEntries = 3u;

/// A ray enters the media where its transmittance falls to this.
SHARED_CONST float kEntryTransmittance = 0.99f;

/// The ray of a tile, and the surfaces of its pixels [m along the view axis], split into two groups halfway between
/// near and far:
///
///   near --- near_last            far_first --- far
///
/// Where one flat surface fills the tile the groups overlap: near_last = far and far_first = near. Distances are
/// clamped to the smoke.
struct RayEnds {
  vec2 position_px;  // of the ray: the tile's centre, or a far pixel where one surface occludes another
  float near, near_last, far_first, far;
};
SHARED_SIZE(RayEnds, 24);

/// Head of the list of tiles: indirect dispatch arguments of the march over their pixels.
struct MarchList {
  uvec3 groups;  // of 64 pixels; x and y start at 0, z is 1
  uint count;    // of tiles
};
SHARED_SIZE(MarchList, 16);

/// Workgroups in a row of that dispatch.
SHARED_CONST uint kListedRow = 1024u;

/// Uncertainty of a ray's transmittance at a pixel's depth at which its weight in the interpolation halves.
SHARED_CONST float kDoubt = 0.008f;

/// Uncertainty up to which rays of neighbouring tiles are compared at a depth.
SHARED_CONST float kKnown = 0.05f;

/// Default of FrameConstants::resolve_error.
SHARED_CONST float kResolveError = 3.0f / 255.0f;

/// Radiance times exposure of a brightly lit surface.
SHARED_CONST float kBrightSurface = 0.3f;

/// Tiles per axis.
SHARED_FUNCTION uvec2 tiles_of(uvec2 size_px, uint march_scale) {
  return (size_px + march_scale - 1u) / march_scale;
}

SHARED_END
#endif
