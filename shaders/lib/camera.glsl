// Camera rays.
#ifndef CAMERA_GLSL
#define CAMERA_GLSL
#include "shared/frame.h"

/// A point of the image from the view axis on, in halves of the image.
vec2 camera_xy(Camera camera, vec2 position_px, uvec2 size_px) {
  const vec2 ndc = position_px / vec2(size_px) * 2.0 - 1.0;
  return vec2(camera.shift.x + ndc.x, camera.shift.y - ndc.y);
}

/// Direction through a point of the image; its component along the view axis is 1.
vec3 camera_ray(Camera camera, vec2 position_px, uvec2 size_px) {
  const vec2 xy = (1.0 - camera.parallel) * camera_xy(camera, position_px, size_px);
  return camera.forward + xy.x * camera.right + xy.y * camera.up;
}

/// Where that ray begins.
vec3 camera_origin(Camera camera, vec2 position_px, uvec2 size_px) {
  const vec2 xy = camera.parallel * camera_xy(camera, position_px, size_px);
  return camera.eye_world + xy.x * camera.right + xy.y * camera.up;
}

/// What a point of the image shows at a distance along the view axis.
vec3 camera_point(Camera camera, vec2 position_px, uvec2 size_px, float distance) {
  return camera_origin(camera, position_px, size_px) + distance * camera_ray(camera, position_px, size_px);
}

/// From a point to the camera, of any length.
vec3 to_camera(Camera camera, vec3 p_world) {
  return (1.0 - camera.parallel) * (camera.eye_world - p_world) - camera.parallel * camera.forward;
}

/// Distance along the view axis from reverse depth; huge where no surface was drawn.
float view_distance(Camera camera, float depth) { return depth > 0.0 ? camera.near_z / depth : 1e9; }

#endif
