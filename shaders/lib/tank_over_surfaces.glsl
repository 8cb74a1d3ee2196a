// A tank in a frame: paths end at the frame's surfaces, which are not in the picture, but how much of them is seen.
#ifndef TANK_OVER_SURFACES_GLSL
#define TANK_OVER_SURFACES_GLSL
#include "lib/tank_picture.glsl"

layout(binding = kBindTankSurfaces, r32f) uniform image2D surface_depth;

/// The tank becomes a surface of the frame.
const bool kIsSurface = true;

/// Ends a path that nothing has scattered.
void see_behind(vec3 direction, vec3 weight, inout Seen seen) {
  seen.transmittance = weight.x;
}

/// Distance of the frame's surface in a pixel, along the camera's axis [voxels].
float surface_distance(ivec2 px) {
  const float depth = imageLoad(surface_depth, px).r;
  return depth > 0.0 ? tank.surface_near / depth : kNoCrossing;
}

/// The same along a ray of the pixel.
float along_ray(float distance, vec3 direction) {
  return distance == kNoCrossing ? kNoCrossing : distance / dot(direction, tank.camera.forward);
}

/// The tank as a surface of the frame, where a ray of the pixel meets it.
void store_surface(ivec2 px, vec3 direction, float t) {
  if (t == kNoCrossing) return;
  const float distance = max(t * dot(direction, tank.camera.forward), tank.surface_near);
  imageStore(surface_depth, px, vec4(tank.surface_near / distance));
}

#endif
