// Light in the smoke: rays from the texels of its bricks to the lights and to the sky.
//
//   rows     per brick kTexelListWords words that list the texels that a sample of the march can meet, phase by phase:
//            where each phase begins, where the last ends, and how many texels are new; then a word an entry: in the
//            low half a texel, x + 10 (y + 10 z), in the high half a new one, one that the list before did not have or whose smoke
//            changed at once
//   blocks   per brick and light that reaches it kTexelsPerBrick words, one a texel: two half floats, optical depth of the
//            smoke on the way, share of the light that the scene lets through. For the sky kSkyPages blocks one
//            after the other, of two rays each: their depths
#ifndef BRUME_SMOKE_LIGHT_H
#define BRUME_SMOKE_LIGHT_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_CONST uint kSkyRays = 6u;
SHARED_CONST uint kSkyPages = 3u;
/// Parts of a brick's texels that can be lit in frames of their own.
SHARED_CONST uint kLightPhases = 16u;
/// At most as many texels of a brick are in one.
SHARED_CONST uint kTexelsPerPhase = 64u;
SHARED_CONST uint kTexelListHead = 18u;
SHARED_CONST uint kTexelListWords = 1018u;
SHARED_CONST uint kSkyTarget = 0xfffffff0u;
/// Workgroups along an axis of a dispatch, after which the next axis begins.
SHARED_CONST uint kLightGroups = 32768u;

/// Which of a row's texels: those of phases from a first one up to an end, or the new ones.
SHARED_FUNCTION uint phase_range(uint first, uint end) { return first | end << 8u; }
SHARED_CONST uint kAllTexels = 0x1000u;  // phase_range(0, kLightPhases)
SHARED_CONST uint kNewTexels = 0xffffu;

/// A brick whose texels are to be listed.
struct TexelList {
  uint slot;
  uint row;
  uint by_phase;  // 0: all texels in phase 0
  uint had_list;  // 0: none before, no texel is new
  uint first_change, change_count;  // new are also the texels within these changes
};
SHARED_SIZE(TexelList, 24);

/// All that is nearer than `radius` to a stretch of a line [m].
struct LightChange {
  vec3 from_world;
  float radius;
  vec3 to_world;
  float padding;
};
SHARED_SIZE(LightChange, 32);

/// Rays of texels of a brick to one light, or two of each to the sky.
struct ShadowRays {
  uint slot;
  uint row;
  uint light;    // of the frame's lights, or kSkyTarget + number of the sky's block
  uint block;   // where they go
  uint texels;  // which
};
SHARED_SIZE(ShadowRays, 20);

/// A brick whose light is to be put together.
struct LightGather {
  uint slot;
  uint row;
  uint sky_page;   // the first of kSkyPages
  uint first_light;  // into the list of (light, block)
  uint light_count;
  uint texels;  // which
};
SHARED_SIZE(LightGather, 24);

/// Which part of its list a dispatch works on.
struct SmokeLightParams {
  uint first;
  uint count;
  uint threads;  // for each entry of the list, that share its texels
};
SHARED_SIZE(SmokeLightParams, 12);

/// The phase of a texel: texels side by side are of different ones, and two bricks that hold the same voxel, each at its
/// rim, agree on its phase, so that light of different times shows no edges of bricks.
SHARED_FUNCTION uint light_phase(uvec3 texel) {
  uint x = texel.x, y = texel.y, z = texel.z;
  return ((x ^ y ^ z) & 1u) << 3u | ((y ^ z) & 1u) << 2u | (z & 1u) << 1u | ((x ^ y ^ z) >> 1u & 1u);
}

/// Directions of the sky rays: the corners of an octahedron, askew, so that none runs along a floor or a wall.
SHARED_FUNCTION vec3 sky_ray(uint i) {
  vec3 a = vec3(0.80178373f, 0.53452248f, -0.26726124f);
  vec3 b = vec3(-0.34021515f, 0.77592929f, 0.53121313f);
  vec3 axis = i < 2u ? a : i < 4u ? b : cross(a, b);
  return (i & 1u) == 0u ? axis : -axis;
}

SHARED_END
#endif
