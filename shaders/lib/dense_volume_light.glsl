// Light in dense volumes, which are opaque within a voxel or two: along rays in steps of their voxels. The includer
// defines the constant kMedia, the volumes and the push constants `params` of volume_light.comp.
#ifndef DENSE_VOLUME_LIGHT_GLSL
#define DENSE_VOLUME_LIGHT_GLSL
#include "lib/frame.glsl"
#include "lib/media_light.glsl"
#include "lib/sky_light.glsl"
#include "lib/volume_extinction.glsl"
#include "shared/light.h"

/// Beyond all media [m].
const float kFar = 1e6;
/// Steps through each other volume beyond the bounds of a dense one.
const uint kStepsBeyond = 32u;
/// Steps of half a voxel from a point of a dense volume on, before those of a voxel: its surface is that thin.
const uint kHalfSteps = 8u;
/// Beyond it nothing of the light is left.
const float kMostDepth = 16.0;
/// The same of light that is scattered often, which decays more slowly.
const float kMostDepthOften = 64.0;
const uint kDenseDirections = 14u;
/// Least mean transmittance of the directions at which a dense volume is seen.
const float kLeastEscape = 1e-3;

/// Whether a sample that reads this cell of a dense volume can lie in matter.
bool is_near_matter(uint volume, vec3 p_voxel, vec3 cell_voxels) {
  if (any(greaterThan(cell_voxels, vec3(1.0)))) return true;
  for (uint corner = 0u; corner < 9u; ++corner) {
    const vec3 side = corner == 8u ? vec3(0.0) : vec3(corner & 1u, corner >> 1u & 1u, corner >> 2u) * 2.0 - 1.0;
    if (volume_value(volumes[volume].bricks, p_voxel + side * cell_voxels) > 0.0) return true;
  }
  return false;
}

/// Optical depth of what is not a volume along a ray.
float others_depth(vec3 p_world, vec3 direction, float distance) {
  return depth_besides_volumes(media_point(p_world), direction, distance, depth_steps(1.0, kStepsBeyond));
}

/// The part of a ray of `distance` metres in the bounds of a volume, from a point inside of them.
float own_part(uint volume, vec3 p_world, vec3 direction, float distance) {
  const mat4x3 voxel_from_world = matrix_of(volumes[volume].voxel_from_world);
  const VoxelRay ray = VoxelRay(voxel_from_world * vec4(p_world, 1.0), voxel_from_world * vec4(direction, 0.0));
  return clamp(span_in_box(ray, volumes[volume].bounds_min, volumes[volume].bounds_max).y, 0.0, distance);
}

/// Optical depth of all volumes along the first `part` metres of a ray, in steps of the voxels of a dense one.
float fine_depth(uint volume, vec3 p_world, vec3 direction, float part, float most) {
  const vec3 per_metre = abs(matrix_of(volumes[volume].voxel_from_world) * vec4(direction, 0.0));
  const float voxel = 1.0 / max(per_metre.x, max(per_metre.y, per_metre.z));
  const uint mask = volumes_along(p_world, p_world + direction * part);
  float depth = 0.0, t = 0.0;
  for (uint i = 0u; t < part && depth < most; ++i) {
    const float ds = min(i < kHalfSteps ? 0.5 * voxel : voxel, part - t);
    depth += ds * volumes_extinction(mask, p_world + direction * (t + 0.5 * ds), direction * (0.5 * ds));
    t += ds;
  }
  return depth;
}

/// Optical depths along a ray from a point of a dense volume.
struct DenseDepth {
  float own;  // in its bounds, where each voxel counts
  float all;  // of all media
};

/// Along the first `distance` metres of a ray; stops once the depth exceeds `most`.
DenseDepth dense_depth(uint volume, vec3 p_world, vec3 direction, float distance, float most) {
  const float part = own_part(volume, p_world, direction, distance);
  DenseDepth depth;
  depth.own = depth.all = fine_depth(volume, p_world, direction, part, most);
  // At most once.
  for (bool others = params.is_alone == 0u && depth.own < most; others; others = false) {
    depth.all += volumes_depth(p_world + direction * part, direction, distance - part, kStepsBeyond, 0u, 1u);
    depth.all += others_depth(p_world, direction, distance);
  }
  return depth;
}

/// What arrives at a point of a volume, as means over the directions.
struct Arrivals {
  float escape;       // transmittance of the volume: what it holds back it may scatter again
  vec2 seen;          // seen_around, through all media
  mat3x2 seen_often;  // in dense volumes the same for light that decays as after many scatterings, a column a channel
};

Arrivals no_arrivals() { return Arrivals(0.0, vec2(0.0), mat3x2(0.0)); }

/// Those at a point of a dense volume: along the axes and the diagonals of a cube, weighted so that polynomials of up
/// to degree 5 are integrated exactly (Lebedev 1976). `around`: sky_around.
Arrivals dense_arrivals(uint volume, vec3 p_world, vec4 around, vec3 decay) {
  Arrivals sum = no_arrivals();
  for (uint i = 0u; i < kDenseDirections; ++i) {
    const bool is_axis = i < 6u;
    const uint corner = i - 6u;
    const vec3 diagonal = vec3(corner & 1u, corner >> 1u & 1u, corner >> 2u) * 2.0 - 1.0;
    const vec3 direction = is_axis ? cube_forward(i) : diagonal * inversesqrt(3.0);
    const float weight = is_axis ? 1.0 / 15.0 : 3.0 / 40.0;
    const DenseDepth depth = dense_depth(volume, p_world, direction, kFar, kMostDepth);
    sum.escape += weight * exp(-depth.own);
    const vec2 seen = weight * seen_around(around, direction);
    sum.seen += exp(-depth.all) * seen;
    sum.seen_often += outerProduct(seen, exp(-decay * depth.all));
  }
  return sum;
}

#endif
