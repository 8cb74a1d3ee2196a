// Radiance of the sky.
#ifndef SKY_GLSL
#define SKY_GLSL
#include "shared/frame.h"
#include "shared/hash.h"

/// Stars in fixed directions: at most one per cell of a cube grid, few of them bright.
float star_light(vec3 direction) {
  const vec3 a = abs(direction);
  const float major = max(a.x, max(a.y, a.z));
  const vec3 on_cube = direction / major * 64.0;
  const uvec3 cell = uvec3(ivec3(floor(on_cube)) + 1024);
  const vec3 random = hash3(cell), more = hash3(cell + 4096u);
  if (more.x > 0.3) return 0.0;
  const vec3 star = (floor(on_cube) + 0.1 + 0.8 * random) / 64.0;
  const float offset = length(normalize(star) - direction);
  return (0.04 + pow(more.y, 10.0)) * smoothstep(0.0016, 0.0003, offset);
}

vec3 sky_radiance(Sky sky, vec3 direction) {
  const float height = max(direction.y, 0.0);
  const vec3 gradient = mix(sky.horizon, sky.zenith, 1.0 - exp(-4.0 * height));
  return gradient + sky.stars * star_light(direction) * smoothstep(0.02, 0.3, direction.y);
}

#endif
