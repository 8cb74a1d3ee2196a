// Debug views of voxels: the solid ones of the level, and those of the smoke by their distance from the source.
#ifndef VOXEL_VIEWS_GLSL
#define VOXEL_VIEWS_GLSL
#include "lib/view_pixel.glsl"
#include "lib/voxel_rays.glsl"

/// The two axes of a face, as unit steps.
void face_axes(ivec3 normal, out ivec3 u, out ivec3 v) {
  u = normal.x != 0 ? ivec3(0, 1, 0) : ivec3(1, 0, 0);
  v = normal.z != 0 ? ivec3(0, 1, 0) : ivec3(0, 0, 1);
}

/// Position of the hit on a face with these axes, [0, 1].
vec2 on_face(ViewPixel pixel, VoxelHit hit, ivec3 u, ivec3 v) {
  const vec3 in_voxel = eye_voxel() + pixel.direction * hit.t - vec3(hit.voxel);
  return clamp(vec2(dot(in_voxel, vec3(u)), dot(in_voxel, vec3(v))), 0.0, 1.0);
}

vec3 solid_view(ViewPixel pixel) {
  const VoxelHit hit = first_voxel(eye_voxel(), pixel.direction, 0.0, 1e6);
  if (hit.value == 0u) return backdrop();
  ivec3 u, v;
  face_axes(hit.normal, u, v);
  const vec2 f = on_face(pixel, hit, u, v);
  uint around = 0u;
  for (int i = 0; i < 9; ++i) {
    if (i != 4) around |= voxel_at(hit.voxel + hit.normal + (i % 3 - 1) * u + (i / 3 - 1) * v) << uint(i);
  }
  const float distance_m = hit.t * params.voxel_size;
  const bool outside = hit.normal != ivec3(0);
  const float width = pixel_voxels(pixel, distance_m, abs(dot(vec3(hit.normal), pixel.direction)));
  const float light = outside ? face_light(around, f) : 1.0, line = outside ? grid_line(f, width) : 0.0;
  return solid_colour(hit.normal, light, line, distance_m);
}

/// Distance of a voxel from the smoke's source [m].
float entry_metres(uint entry) { return float(entry - 1u) * 0.1 * params.voxel_size; }

/// Coverage of lines at whole metres from the source: edges between voxels on either side of one.
float iso_line(VoxelHit hit, ivec3 normal, vec2 f, float width) {
  ivec3 u, v;
  face_axes(normal, u, v);
  const float own = floor(entry_metres(hit.value));
  float line = 0.0;
  for (int i = 0; i < 4; ++i) {
    const uint other = voxel_at(hit.voxel + (i < 2 ? u : v) * (i % 2 * 2 - 1));
    const float x = i < 2 ? f.x : f.y;
    const bool both_reached = other != 0u && other != kUnreached && hit.value != kUnreached;
    const bool differs = both_reached && floor(entry_metres(other)) != own;
    line = max(line, differs ? line_coverage(i % 2 == 0 ? x : 1.0 - x, 1.5 * width) : 0.0);
  }
  return line;
}

/// Smoke voxels closer to the eye are hidden [m].
const float kCleared = 1.0;

vec3 distance_view(ViewPixel pixel) {
  // Cut open at the slice: shows the part beyond it.
  const vec3 behind = dimmed_scene(pixel);
  const float t_slice = slice_distance(pixel);
  if (!(t_slice > 0.0 && t_slice < 1e6)) return behind;
  const float t_begin = max(kCleared, t_slice) / params.voxel_size;
  const VoxelHit hit = first_voxel(eye_voxel(), pixel.direction, t_begin, 1e6);
  if (hit.value == 0u) return behind;

  const float distance_m = hit.t * params.voxel_size;
  ivec3 normal = hit.normal;
  if (normal == ivec3(0)) normal[params.slice_axis] = pixel.direction[params.slice_axis] > 0.0 ? -1 : 1;
  ivec3 u, v;
  face_axes(normal, u, v);
  const vec2 f = on_face(pixel, hit, u, v);
  const float width = pixel_voxels(pixel, distance_m, abs(dot(vec3(normal), pixel.direction)));
  const float lines = max(0.18 * grid_line(f, width), 0.75 * iso_line(hit, normal, f, width));
  const vec3 tinted = distance_colour(hit.value, entry_metres(hit.value), params.full) * distance_tone(normal);
  return over_surface(pixel, distance_m, behind, min(tinted, vec3(1.0)) * (1.0 - lines));
}

#endif
