// A tank alone: behind it is its air.
#ifndef TANK_OVER_AIR_GLSL
#define TANK_OVER_AIR_GLSL
#include "lib/tank_air.glsl"
#include "lib/tank_picture.glsl"

/// The tank becomes no surface of a frame.
const bool kIsSurface = false;

/// Ends a path that nothing has scattered.
void see_behind(vec3 direction, vec3 weight, inout Seen seen) {
  seen.radiance += weight * backdrop(direction);
}

float surface_distance(ivec2 px) { return kNoCrossing; }
float along_ray(float distance, vec3 direction) { return distance; }
void store_surface(ivec2 px, vec3 direction, float t) {}

#endif
