// Camera rays.
#ifndef CAMERA_GLSL
#define CAMERA_GLSL
#include "shared/frame.h"

/// Direction through a point of the image; its component along the view axis is 1.
vec3 camera_ray(Camera camera, vec2 position_px, uvec2 size_px) {
  const vec2 ndc = position_px / vec2(size_px) * 2.0 - 1.0;
  return camera.forward + (camera.shift.x + ndc.x) * camera.right + (camera.shift.y - ndc.y) * camera.up;
}

/// Distance along the view axis from reverse depth; huge where no surface was drawn.
float view_distance(Camera camera, float depth) { return depth > 0.0 ? camera.near_z / depth : 1e9; }

#endif
