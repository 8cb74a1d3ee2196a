// Cones around camera rays.
#ifndef RAY_CONE_GLSL
#define RAY_CONE_GLSL
#include "lib/camera.glsl"
#include "lib/frame.glsl"
#include "lib/hole_reach.glsl"

/// A cone around all rays through a rectangle of pixels; a cylinder in a parallel view.
RayCone cone_of_pixels(vec2 low_px, vec2 high_px, float length_m) {
  RayCone cone;
  const vec2 middle_px = 0.5 * (low_px + high_px);
  cone.origin_world = camera_origin(frame.camera, middle_px, frame.size_px);
  cone.axis = normalize(camera_ray(frame.camera, middle_px, frame.size_px));
  cone.length_m = length_m;
  cone.radius = cone.spread = 0.0;
  for (uint i = 0u; i < 4u; ++i) {
    const vec2 px = vec2((i & 1u) == 0u ? low_px.x : high_px.x, (i & 2u) == 0u ? low_px.y : high_px.y);
    const vec3 ray = camera_ray(frame.camera, px, frame.size_px);
    cone.radius = max(cone.radius, distance(camera_origin(frame.camera, px, frame.size_px), cone.origin_world));
    cone.spread = max(cone.spread, length(cross(cone.axis, ray)) / max(dot(cone.axis, ray), 1e-3));
  }
  return cone;
}

#endif
