// Light in the smoke: rays from the texels of its bricks to the lamps and to the sky.
//
//   rows     per brick kLightRow words: how many of its texels a sample of the march can meet, then these texels,
//            x + 10 (y + 10 z)
//   blocks   per brick and lamp that reaches it kTexelsPerBrick words, one a texel: two half floats, optical depth of the
//            smoke on the way, share of the light that the scene lets through. For the sky kSkyBlocks blocks one
//            after the other, of two rays each: their depths
#ifndef BRUME_SMOKE_LIGHT_H
#define BRUME_SMOKE_LIGHT_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_CONST uint kSkyRays = 6u;
SHARED_CONST uint kSkyBlocks = 3u;
SHARED_CONST uint kLightRow = 1001u;
SHARED_CONST uint kTowardSky = 0xfffffff0u;
/// Workgroups along an axis of a dispatch, after which the next axis begins.
SHARED_CONST uint kLightGroups = 32768u;

/// A brick and the row of its texels.
struct LightRow {
  uint slot;
  uint row;
};
SHARED_SIZE(LightRow, 8);

/// Rays of all texels of a brick to one lamp, or two of each to the sky.
struct LightPair {
  uint slot;
  uint row;
  uint lamp;   // of the frame's lights, or kTowardSky + number of the sky's block
  uint block;  // where they go
};
SHARED_SIZE(LightPair, 16);

/// A brick whose light is to be put together.
struct LightBrick {
  uint slot;
  uint row;
  uint sky_block;   // the first of kSkyBlocks
  uint first_lamp;  // into the list of (lamp, block)
  uint lamp_count;
};
SHARED_SIZE(LightBrick, 20);

/// Which part of its list a dispatch works on.
struct SmokeLightParams {
  uint first;
  uint count;
};
SHARED_SIZE(SmokeLightParams, 8);

/// Directions of the sky rays: the corners of an octahedron, askew, so that none runs along a floor or a wall.
SHARED_FUNCTION vec3 sky_ray(uint i) {
  vec3 a = vec3(0.80178373f, 0.53452248f, -0.26726124f);
  vec3 b = vec3(-0.34021515f, 0.77592929f, 0.53121313f);
  vec3 axis = i < 2u ? a : i < 4u ? b : cross(a, b);
  return (i & 1u) == 0u ? axis : -axis;
}

SHARED_END
#endif
