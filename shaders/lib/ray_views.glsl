// Debug views of a value per ray: length cleared by holes, steps of the march, bricks of the smoke.
#ifndef RAY_VIEWS_GLSL
#define RAY_VIEWS_GLSL
#include "lib/ray_holes.glsl"
#include "lib/ray_bounds.glsl"
#include "lib/view_pixel.glsl"
#include "lib/voxel_rays.glsl"
#include "shared/resolve.h"

layout(scalar, binding = kBindFilled) readonly buffer Filled { uint filled[]; };
layout(scalar, binding = kBindMarchCounters) readonly buffer Counters {
  uint texture_samples;
  uint ray_steps[];
};

vec3 holes_view(ViewPixel pixel) {
  const VolumeLayout smoke = frame.smoke;
  MediaBox box;
  box.low = smoke.origin_world + smoke.bounds_min * smoke.voxel_size;
  box.high = smoke.origin_world + smoke.bounds_max * smoke.voxel_size;
  const vec2 inside = clip_to_box(box, frame.camera.eye_world, pixel.direction, pixel.surface_m);
  const RayHoles holes = holes_of_ray(vec2(pixel.px) + 0.5);
  // Fine enough for the narrowest shots: a quarter of the march's step.
  const float fine = clamp(ceil(4.0 * (inside.y - inside.x) / frame.look.step_length), 0.0, 4096.0);
  const float count = holes.chunk == 0u ? 0.0 : fine;
  const float ds = (inside.y - inside.x) / max(count, 1.0);
  float cleared_m = 0.0;
  for (float i = 0.5; i < count; i += 1.0) {
    const float t = inside.x + i * ds;
    const vec3 p_world = frame.camera.eye_world + pixel.direction * t;
    cleared_m += ds * (1.0 - remaining_after_holes(holes, t, p_world, 0.0, true));
  }
  return heat_colour(ramp_of_view(kView), cleared_m / params.full, dimmed_scene(pixel));
}

vec3 steps_view(ViewPixel pixel) {
  const uint steps = ray_steps[uint(pixel.px.x) + frame.size_px.x * uint(pixel.px.y)];
  return heat_colour(ramp_of_view(kView), float(steps) / params.full, dimmed_scene(pixel));
}

/// A transparent box on a ray.
struct BoxOnRay {
  float line;    // coverage of the edges of the faces through which the ray enters and leaves
  float inside;  // length of the ray inside the box [voxels]
};

BoxOnRay box_on_ray(ViewPixel pixel, vec3 origin, vec3 low, vec3 high, float t_end) {
  const vec3 direction = pixel.direction;
  const vec3 inverse = vec3(dda_inverse(direction.x), dda_inverse(direction.y), dda_inverse(direction.z));
  const vec3 a = (low - origin) * inverse, b = (high - origin) * inverse;
  const float enter = max(dda_max(min(a, b)), 0.0), leave = min(dda_min(max(a, b)), t_end);
  BoxOnRay box = BoxOnRay(0.0, max(leave - enter, 0.0));
  if (enter >= leave) return box;
  for (int end = 0; end < 2; ++end) {
    const float t = end == 0 ? enter : leave;
    const vec3 at = origin + direction * t;
    const vec3 to_face = min(abs(at - low), abs(at - high));
    // One distance is 0 on a face; the second smallest is the distance to an edge.
    const float second = to_face.x + to_face.y + to_face.z - dda_max(to_face) - dda_min(to_face);
    const float width = pixel_voxels(pixel, t * params.voxel_size, 1.0);
    box.line = max(box.line, t < t_end ? line_coverage(second, width) * (end == 0 ? 1.0 : 0.4) : 0.0);
  }
  return box;
}

/// Colour and opacity of a brick of the smoke and of its filled cells.
vec4 brick_on_ray(ViewPixel pixel, vec3 origin, ivec3 cell, uint slot, float t_end) {
  const vec3 low = vec3(cell * kBrickVoxels);
  const vec3 fill_low = vec3(cells_low(filled[slot])), fill_high = vec3(cells_end(filled[slot]));
  const vec3 fill = max(fill_high - fill_low, vec3(0.0));
  const float fraction = fill.x * fill.y * fill.z / float(kCellsPerBrick);
  const BoxOnRay brick = box_on_ray(pixel, origin, low, low + float(kBrickVoxels), t_end);
  // Cell 0 of a brick begins half a voxel before it.
  const vec3 from = low + max(fill_low - 0.5, vec3(0.0)), to = low + min(fill_high - 0.5, vec3(float(kBrickVoxels)));
  BoxOnRay cells = BoxOnRay(0.0, 0.0);
  if (fraction > 0.0) cells = box_on_ray(pixel, origin, from, to, t_end);
  const vec3 tint = ramp_colour(kRampViridis, 0.15 + 0.85 * fraction);
  const vec3 edges = fraction > 0.0 ? tint * 0.5 + 0.5 : vec3(0.75, 0.3, 0.3);
  return vec4(mix(tint, edges, brick.line), max(0.9 * brick.line, 1.0 - exp2(-0.05 * cells.inside)));
}

vec3 bricks_view(ViewPixel pixel) {
  vec3 colour = vec3(0.0);
  float through = 1.0;
  const vec3 origin = eye_voxel();
  const float t_end = pixel.surface_m / params.voxel_size;
  const BrickLayout bricks = frame.smoke.bricks;
  const ivec3 first = bricks.window_origin * kNodeBricks, last = first + bricks.window_size * kNodeBricks;
  Dda d = dda_begin(origin, pixel.direction, first, last, kBrickVoxels, 0.0, t_end);
  while (d.t < d.t_end && through > 0.02) {
    const uint slot = smoke_brick(d.cell);
    if (slot != kNoSlot) {
      const vec4 brick = brick_on_ray(pixel, origin, d.cell, slot, t_end);
      colour += through * brick.a * brick.rgb;
      through *= 1.0 - brick.a;
    }
    d = dda_step(d);
  }
  return colour + through * dimmed_scene(pixel);
}

#endif
