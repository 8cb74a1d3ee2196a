// What surrounds a tank, and the fog in it.
#ifndef TANK_AIR_GLSL
#define TANK_AIR_GLSL
#include "lib/tank.glsl"

/// What rays of the camera see behind the tank.
vec3 backdrop(vec3 direction) {
  return mix(tank.air.horizon, tank.air.zenith, clamp(direction.y * 0.5 + 0.5, 0.0, 1.0));
}

/// The fog on a ray up to t_end: adds its radiance, and returns its transmittance.
float add_fog(vec3 origin, vec3 direction, float t_end, vec3 weight, inout vec3 radiance) {
  if (tank.air.fog_extinction <= 0.0) return 1.0;
  const vec2 inside = tank_crossings(origin, inverse_of(direction));
  const float clear = exp(-tank.air.fog_extinction * max(0.0, min(inside.y, t_end) - inside.x));
  radiance += weight * tank.air.fog_color * (1.0 - clear);
  return clear;
}

#endif
