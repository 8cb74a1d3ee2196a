// Light in the smoke: rays from the texels of its bricks to the lights and to the sky.
//
//   rows     per brick kTexelListWords words: the texels that samples of the march can read, phase by phase. The head
//            holds the start of each phase, the end of the last, and the number of new texels. Then one word per entry:
//            in the low half a texel, x + 10 (y + 10 z), in the high half a new texel: one that the previous list
//            lacked or whose smoke changed abruptly
//   blocks   per brick and light that reaches it kTexelsPerBrick words, one per texel: two half floats, optical depth
//            of the smoke along the ray and visibility of the light through the scene. For the sky kSkyPages
//            consecutive blocks of two rays each: their optical depths
#ifndef BRUME_SMOKE_LIGHT_H
#define BRUME_SMOKE_LIGHT_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindTexelLists, 32u);
SHARED_BINDING(kBindLightRows, 33u);
SHARED_BINDING(kBindLightChanges, 34u);
SHARED_BINDING(kBindShadowRays, 35u);
SHARED_BINDING(kBindLightBlocks, 36u);
SHARED_BINDING(kBindLightGathers, 37u);
SHARED_BINDING(kBindBrickLights, 38u);

SHARED_CONST uint kSkyRays = 6u;
SHARED_CONST uint kSkyPages = 3u;
/// Time slices: subsets of a brick's texels that are lit in different frames.
SHARED_CONST uint kLightPhases = 16u;
/// Upper limit of the texels of a brick in one phase.
SHARED_CONST uint kTexelsPerPhase = 64u;
SHARED_CONST uint kTexelListHead = 18u;
SHARED_CONST uint kTexelListWords = 1018u;
SHARED_CONST uint kSkyTarget = 0xfffffff0u;
/// Workgroups along one axis of a dispatch before the next axis is used.
SHARED_CONST uint kLightGroups = 32768u;

/// Selects texels of a row: those of the phases [first, end), or kNewTexels.
SHARED_FUNCTION uint phase_range(uint first, uint end) { return first | end << 8u; }
SHARED_CONST uint kAllTexels = 0x1000u;  // phase_range(0, kLightPhases)
SHARED_CONST uint kNewTexels = 0xffffu;

/// A brick whose texels are to be listed.
struct TexelList {
  uint slot;
  uint row;
  uint by_phase;  // 0: all texels in phase 0
  uint had_list;  // 0: no previous list, no texel counts as new
  uint first_change, change_count;  // texels within these changes count as new too
};
SHARED_SIZE(TexelList, 24);

/// An abrupt change of smoke: a capsule around a segment [m].
struct LightChange {
  vec3 from_world;
  float radius;
  vec3 to_world;
  float padding SHARED_ZERO;
};
SHARED_SIZE(LightChange, 32);

/// Rays from texels of a brick to one light, or two per texel to the sky.
struct ShadowRays {
  uint slot;
  uint row;
  uint light;   // index of a light, or kSkyTarget + index of the sky's block
  uint block;   // that receives the results
  uint texels;  // phase_range or kNewTexels
};
SHARED_SIZE(ShadowRays, 20);

/// A brick whose in-scattered light is to be summed.
struct LightGather {
  uint slot;
  uint row;
  uint sky_page;     // the first of kSkyPages blocks
  uint first_light;  // into the list of (light, block)
  uint light_count;
  uint texels;       // phase_range or kNewTexels
};
SHARED_SIZE(LightGather, 24);

/// The part of its list that a dispatch works on.
struct SmokeLightParams {
  uint first;
  uint count;
  uint threads;  // per entry of the list, looping over its texels
};
SHARED_SIZE(SmokeLightParams, 12);

/// Phase of a texel. Neighbouring texels have different phases. Two bricks that hold the same voxel in their aprons
/// agree on its phase, so light of different ages shows no brick edges.
SHARED_FUNCTION uint light_phase(uvec3 texel) {
  uint x = texel.x, y = texel.y, z = texel.z;
  return ((x ^ y ^ z) & 1u) << 3u | ((y ^ z) & 1u) << 2u | (z & 1u) << 1u | ((x ^ y ^ z) >> 1u & 1u);
}

/// Directions of the sky rays: the corners of a rotated octahedron, oblique to floors and walls.
SHARED_FUNCTION vec3 sky_ray(uint i) {
  vec3 a = vec3(0.80178373f, 0.53452248f, -0.26726124f);
  vec3 b = vec3(-0.34021515f, 0.77592929f, 0.53121313f);
  vec3 axis = i < 2u ? a : i < 4u ? b : cross(a, b);
  return (i & 1u) == 0u ? axis : -axis;
}

SHARED_END
#endif
