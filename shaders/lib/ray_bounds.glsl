// Rays against boxes of media in the world.
#ifndef RAY_BOUNDS_GLSL
#define RAY_BOUNDS_GLSL
#include "lib/frame.glsl"

/// The part of a ray inside a box [m], from 0 to t_end: x >= y where there is none.
vec2 clip_to_box(MediaBox box, vec3 origin_world, vec3 direction, float t_end) {
  const vec3 inverse = 1.0 / (direction + vec3(equal(direction, vec3(0.0))) * 1e-9);
  const vec3 low = box.low - origin_world, high = box.high - origin_world;
  const vec3 near = min(low * inverse, high * inverse), far = max(low * inverse, high * inverse);
  return vec2(max(max(near.x, near.y), max(near.z, 0.0)), min(min(far.x, far.y), min(far.z, t_end)));
}

void join_box(MediaBox box, vec3 origin_world, vec3 direction, float t_end, inout vec2 inside) {
  const vec2 span = clip_to_box(box, origin_world, direction, t_end);
  if (span.x < span.y) inside = inside.x < inside.y ? vec2(min(inside.x, span.x), max(inside.y, span.y)) : span;
}

/// From where a ray enters the first box of the media to where it leaves the last.
vec2 clip_to_media(vec3 origin_world, vec3 direction, float t_end) {
  const FrameMedia media = frame.media;
  vec2 inside = clip_to_box(media.box_0, origin_world, direction, t_end);
  if (media.box_count > 1u) {
    join_box(media.box_1, origin_world, direction, t_end, inside);
    if (media.box_count > 2u) join_box(media.box_2, origin_world, direction, t_end, inside);
    if (media.box_count > 3u) join_box(media.box_3, origin_world, direction, t_end, inside);
  }
  return inside;
}

#endif
