// Light in the smoke: rays from the texels of its bricks to the lamps and to the sky.
//
//   texels       the texels that a sample of the march can meet and that may be in view: 1000 slot + texel of the brick
//   rays         those of their rays that are not in the shadow of the scene: rays_per_texel * rank of the texel + ray
//   ray_light    per texel and ray two half floats: optical depth of the smoke on the way, share of the light that
//                the scene lets through. The last kSkyRays rays of a texel go to the sky, the others to the lamps
#ifndef BRUME_SMOKE_LIGHT_H
#define BRUME_SMOKE_LIGHT_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_CONST uint kSkyRays = 6u;

struct SmokeLightParams {
  uint first_slot;  // into the list of slots that may be in view
  uint slot_count;
  uint rays_per_texel;
  uint max_steps;  // most steps through the smoke along a ray
};
SHARED_SIZE(SmokeLightParams, 16);

struct SmokeLightCounters {
  uint texels;
  uint rays;
};
SHARED_SIZE(SmokeLightCounters, 8);

/// Directions of the sky rays: the corners of an octahedron, askew, so that none runs along a floor or a wall.
SHARED_FUNCTION vec3 sky_ray(uint i) {
  vec3 a = vec3(0.80178373f, 0.53452248f, -0.26726124f);
  vec3 b = vec3(-0.34021515f, 0.77592929f, 0.53121313f);
  vec3 axis = i < 2u ? a : i < 4u ? b : cross(a, b);
  return (i & 1u) == 0u ? axis : -axis;
}

SHARED_END
#endif
