// The march that both forms of raycasting share, so that they step alike.
//
// Steps lie on a lattice of the ray, [n ds, (n + 1) ds) from the eye, clipped to the interval inside the volume; each
// is sampled in its middle. What a step weighs and where it is sampled are continuous functions of the interval's ends,
// so that rounding of the ends cannot change a pixel visibly.
#ifndef RAYCAST_MARCH_GLSL
#define RAYCAST_MARCH_GLSL
#include "lib/volume_values.glsl"
#include "shared/gbuffer.h"
#include "shared/raycast.h"

layout(scalar, binding = kBindRaycastView) readonly buffer View { RaycastView view; };
layout(scalar, binding = kBindRaycastVolumes) readonly buffer Raycast { RaycastVolume raycast[]; };
layout(binding = kBindDepth) uniform sampler2D depth;

/// The ray of a pixel in voxel space, t in metres from the eye.
struct RaycastRay {
  VoxelRay voxel;
  vec3 direction;  // [view space]
  float t_scene;   // of the surface behind
};

RaycastRay raycast_ray(uint volume, ivec2 pixel) {
  const vec2 window = vec2(view.size_px), ndc = 2.0 * (vec2(pixel) + 0.5) / window - 1.0;
  const vec3 along =
      vec3((view.shift.x + ndc.x) * window.x / window.y, view.shift.y - ndc.y, -view.focal_length);
  RaycastRay ray;
  ray.direction = normalize(along);
  const mat4x3 voxel_from_view = matrix_of(raycast[volume].voxel_from_view);
  ray.voxel = VoxelRay(voxel_from_view[3], mat3(voxel_from_view) * ray.direction);
  // Depth is a distance along the view axis; the ray is longer the farther it is from the axis.
  const float reverse_depth = texelFetch(depth, pixel, 0).r;
  ray.t_scene = reverse_depth > 0.0 ? view.near_z / reverse_depth / -ray.direction.z : 1e30;
  return ray;
}

/// The part of a ray inside of the volume's box, in metres: x >= y where there is none.
vec2 intersect_box(uint volume, VoxelRay ray) {
  const vec3 inverse = inverse_of(ray);
  const vec3 a = (raycast[volume].bounds_min - ray.origin) * inverse;
  const vec3 b = (raycast[volume].bounds_max - ray.origin) * inverse;
  const vec3 enters = min(a, b), leaves = max(a, b);
  return vec2(max(max(enters.x, enters.y), max(enters.z, 0.0)), min(leaves.x, min(leaves.y, leaves.z)));
}

/// The brick around the last sample; looked up again only behind it.
struct BrickCursor {
  BrickAt brick;
  float t_leave;  // where the ray leaves it
};

void move_to(BrickLayout bricks, VoxelRay ray, float t, inout BrickCursor cursor) {
  if (t < cursor.t_leave) return;
  cursor.brick = volume_brick(bricks, ray.origin + ray.per_metre * t);
  const vec3 inverse = inverse_of(ray), to_low = (cursor.brick.low - ray.origin) * inverse;
  const vec3 exits = max(to_low, to_low + cursor.brick.edge * inverse);
  cursor.t_leave = min(exits.x, min(exits.y, exits.z));
}

/// Step n of a ray.
struct RaycastStep {
  float t, ds;  // middle and length [m]
};

RaycastStep raycast_step(float n, float t_first, float ds, vec2 interval) {
  const float begin = max(t_first + n * ds, interval.x), end = min(t_first + (n + 1.0) * ds, interval.y);
  return RaycastStep(0.5 * (begin + end), max(end - begin, 0.0));
}

/// The step behind step n, or the first whose middle is not in the empty cube.
float next_step(float n, float t_first, float ds, BrickCursor cursor) {
  return cursor.brick.slot != kNoSlot ? n + 1.0 : max(n + 1.0, ceil((cursor.t_leave - t_first) / ds - 0.5));
}

/// Integral of density from a point to where its ray to the sun leaves the box [m].
float density_towards_sun(uint volume, vec3 p_voxel) {
  const VoxelRay ray = VoxelRay(p_voxel, raycast[volume].to_sun);
  const vec2 interval = vec2(0.0, intersect_box(volume, ray).y);
  const float ds = raycast[volume].light_step_length, count = ceil(interval.y / ds);
  BrickCursor cursor = BrickCursor(BrickAt(vec3(0.0), 0.0, kNoSlot, 0.0), 0.0);
  float sum = 0.0;
  for (float n = 0.0; n < count; n = next_step(n, 0.0, ds, cursor)) {
    const RaycastStep here = raycast_step(n, 0.0, ds, interval);
    move_to(volumes[volume].bricks, ray, here.t, cursor);
    if (cursor.brick.slot == kNoSlot) continue;
    const vec3 p = ray.origin + ray.per_metre * here.t;
    sum += here.ds * volume_value(volumes[volume].bricks, cursor.brick, p);
  }
  return sum;
}

/// Premultiplied radiance and transmittance of the part of a ray in an interval.
vec4 raycast_march(uint volume, RaycastRay ray, vec2 interval) {
  interval.y = min(interval.y, ray.t_scene);
  const VolumeLook look = volumes[volume].look;
  const vec3 sun = view.sun_irradiance * phase_value(view.phase, dot(ray.direction, view.sun_direction));
  const float ds = raycast[volume].step_length, t_first = floor(interval.x / ds) * ds;
  const float count = ceil((interval.y - t_first) / ds);
  BrickCursor cursor = BrickCursor(BrickAt(vec3(0.0), 0.0, kNoSlot, 0.0), 0.0);
  vec3 radiance = vec3(0.0);
  float transmittance = 1.0;
  for (float n = 0.0; n < count; n = next_step(n, t_first, ds, cursor)) {
    const RaycastStep here = raycast_step(n, t_first, ds, interval);
    move_to(volumes[volume].bricks, ray.voxel, here.t, cursor);
    if (cursor.brick.slot == kNoSlot) continue;
    const vec3 p = ray.voxel.origin + ray.voxel.per_metre * here.t;
    const float density = volume_value(volumes[volume].bricks, cursor.brick, p);
    if (density <= 0.0) continue;
    // In-scatter is constant over the step, so its integral is exact.
    const float passed = exp(-look.extinction * density * here.ds);
    const float lit = exp(-look.extinction * density_towards_sun(volume, p));
    const vec3 source = look.albedo * (view.ambient + lit * sun) + look.emission;
    radiance += transmittance * (1.0 - passed) * source;
    transmittance *= passed;
    if (transmittance < view.opaque_transmittance) return vec4(radiance, 0.0);
  }
  return vec4(radiance, transmittance);
}

#endif
