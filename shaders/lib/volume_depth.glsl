// Optical depth of the volumes besides the smoke along rays to lights. The includer defines the constant kMedia.
#ifndef VOLUME_DEPTH_GLSL
#define VOLUME_DEPTH_GLSL
#include "lib/frame.glsl"
#include "lib/volume_transfer.glsl"

/// Of the part of a ray up to `distance` metres, `direction` unit: each volume in `steps` equal steps inside of its
/// bounds, of which this counts every `stride`-th from `first` on.
float volumes_depth(vec3 from_world, vec3 direction, float distance, uint steps, uint first, uint stride) {
  float depth = 0.0;
  for (uint v = 0u; v < frame.media.caster_count; ++v) {
    const mat4x3 voxel_from_world = matrix_of(volumes[v].voxel_from_world);
    const VoxelRay ray = VoxelRay(voxel_from_world * vec4(from_world, 1.0), voxel_from_world * vec4(direction, 0.0));
    const vec2 inside = span_in_box(ray, volumes[v].bounds_min, volumes[v].bounds_max);
    const float begin = max(inside.x, 0.0), end = min(inside.y, distance);
    const float ds = (end - begin) / float(steps);
    for (uint i = first; i < steps && ds > 0.0; i += stride) {
      const vec3 p_voxel = ray.origin + ray.per_metre * (begin + (float(i) + 0.5) * ds);
      const float density = kHasTransfer ? matter_around(volumes[v], v, p_voxel, 0.5 * ds * ray.per_metre).density
                                         : volume_value(volumes[v].bricks, p_voxel);
      depth += ds * volumes[v].look.extinction * density;
    }
  }
  return depth;
}

#endif
