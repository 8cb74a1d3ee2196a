// Paths through the glass before a tank.
#ifndef TANK_GLASS_GLSL
#define TANK_GLASS_GLSL
#include "lib/tank.glsl"

const float kNoCrossing = 1e30;

bool has_glass() { return tank.glass.index > 0.0; }

bool is_in_glass(vec3 at) {
  const vec3 p = (at - tank.glass.center) / tank.glass.radii;
  return has_glass() && dot(p, p) < 1.0;
}

/// How far a ray goes until it meets the surface of the glass, from inside or outside.
float distance_to_glass(vec3 origin, vec3 direction, bool inside) {
  if (!has_glass()) return kNoCrossing;
  const vec2 crossed = glass_crossings(tank.glass, origin, direction);
  if (crossed.y < crossed.x) return kNoCrossing;
  if (inside) return max(crossed.y, 0.0);
  // A ray that leaves the surface outwards has its entry behind it.
  return crossed.x > 0.0 && crossed.y - crossed.x > 1e-4 ? crossed.x : kNoCrossing;
}

/// Reflects or refracts a ray that has arrived at the surface of the glass, by `random` in [0, 1).
void cross_glass(vec3 at, float random, inout vec3 direction, inout bool inside) {
  vec3 normal = glass_normal(tank.glass, at);
  if (inside) normal = -normal;
  const float ratio = inside ? tank.glass.index : 1.0 / tank.glass.index;
  const float cosine = clamp(-dot(direction, normal), 0.0, 1.0);
  if (random < fresnel_reflectance(cosine, ratio)) {
    direction = mirrored(direction, normal);
    return;
  }
  const vec3 behind = refracted(direction, normal, ratio);
  if (behind == vec3(0.0)) {
    direction = mirrored(direction, normal);
    return;
  }
  direction = behind;
  inside = !inside;
}

#endif
