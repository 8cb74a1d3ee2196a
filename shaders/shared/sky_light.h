// Sky light in the level: directional visibility of the sky at each texel of the solid volume.
//
// Per texel the radiance of the visible sky as two bands of spherical harmonics in plain form, c.x + dot(c.yzw, d), for
// a sky of mean radiance 1 (sky_shape); 0 in solid texels.
#ifndef BRUME_SKY_LIGHT_H
#define BRUME_SKY_LIGHT_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindSkyLight, 17u);
SHARED_BINDING(kBindSolidWords, 32u);
SHARED_BINDING(kBindSkyRays, 33u);

SHARED_CONST uint kSkyDirections = 32u;

/// Radiance of the ambient sky from a direction. A surface receives 0.75 + 0.25 normal.y of it; the mean over all
/// directions is 3/4.
SHARED_FUNCTION float sky_shape(float direction_y) {
  return 0.75f + 0.375f * direction_y;
}

/// A point of an icosahedron (0 to 11) or of a dodecahedron (12 to 31), unit, rotated so that none is
/// parallel to a wall of voxels.
SHARED_FUNCTION vec3 sky_direction(uint i) {
  const float golden = 1.618033989f;
  float a = (i & 1u) == 0u ? 1.0f : -1.0f, b = (i & 2u) == 0u ? 1.0f : -1.0f, c = (i & 4u) == 0u ? 1.0f : -1.0f;
  uint axis = i < 12u ? i / 4u : (i - 20u) / 4u;
  vec3 p = i < 12u ? vec3(0.0f, a, b * golden) : vec3(0.0f, a * golden, b / golden);
  p = axis == 1u ? vec3(p.z, p.x, p.y) : axis == 2u ? vec3(p.y, p.z, p.x) : p;
  if (i >= 12u && i < 20u) p = vec3(a, b, c);
  p = normalize(p);
  vec3 around = vec3(0.267261242f, 0.534522484f, 0.801783726f);
  return 0.540302306f * p + 0.841470985f * cross(around, p) + (0.459697694f * dot(around, p)) * around;
}

/// Weight of a direction; the weights sum to 1 and integrate polynomials up to the 9th degree over the sphere exactly
/// (Stroud 1971, "Approximate Calculation of Multiple Integrals", rules for the sphere).
SHARED_FUNCTION float sky_weight(uint i) {
  return i < 12u ? 25.0f / 840.0f : 27.0f / 840.0f;
}

/// Step of a ray: one texel along its longest axis, in 1/65536 texels.
SHARED_FUNCTION ivec3 sky_slope(uint i) {
  vec3 d = sky_direction(i);
  vec3 size = abs(d);
  float longest = max(size.x, max(size.y, size.z));
  return ivec3(floor(d * (65536.0f / longest) + vec3(0.5f)));
}

/// Texel that a ray from the centre of texel 0 reaches after some steps.
SHARED_FUNCTION ivec3 sky_step(ivec3 slope, int steps) {
  ivec3 at = slope * steps + ivec3(32768);
  return ivec3(at.x >> 16, at.y >> 16, at.z >> 16);
}

SHARED_END
#endif
