// Extinction of the volumes besides the smoke, of all together. The includer defines the constant kMedia, and enables
// GL_KHR_shader_subgroup_arithmetic.
#ifndef VOLUME_EXTINCTION_GLSL
#define VOLUME_EXTINCTION_GLSL
#include "lib/brick_rays.glsl"
#include "lib/frame.glsl"
#include "lib/volume_transfer.glsl"
#include "shared/volume_detail.h"

/// What is left of a density of a volume on average over its detail, which is finer than light.
float density_left(VolumeInstance volume, float density) {
  if (!kHasVolumeDetail || volume.detail.strength <= 0.0) return density;
  return density * mean_volume_fraction(volume.detail, density);
}

/// Extinction of volume i at a point [1/m]; with a transfer function that of the segment p_world - half_world to
/// p_world + half_world.
float volume_extinction(VolumeInstance volume, uint i, vec3 p_world, vec3 half_world) {
  const mat4x3 voxel_from_world = matrix_of(volume.voxel_from_world);
  const vec3 p_voxel = voxel_from_world * vec4(p_world, 1.0);
  if (any(lessThan(p_voxel, volume.bounds_min)) || any(greaterThan(p_voxel, volume.bounds_max))) return 0.0;
  if (!kHasTransfer) return volume.look.extinction * density_left(volume, volume_value(volume.bricks, p_voxel));
  const vec2 values = end_values(volume, p_voxel, voxel_from_world * vec4(half_world, 0.0));
  return volume.look.extinction * density_left(volume, matter_of(volume, i, values).density);
}

/// Bit i: the segment, or that of another thread of the subgroup, may be inside volume i: all its threads then read the
/// same volumes.
uint volumes_along(vec3 begin_world, vec3 end_world) {
  if (!kHasSeveral) return 1u;
  const float margin = 1e-3;  // of the segment, for rounding
  uint mask = 0u;
  for (uint i = 0u; i < frame.media.caster_count; ++i) {
    const mat4x3 voxel_from_world = matrix_of(volumes[i].voxel_from_world);
    const VoxelRay ray =
        VoxelRay(voxel_from_world * vec4(begin_world, 1.0), voxel_from_world * vec4(end_world - begin_world, 0.0));
    const vec2 inside = span_in_box(ray, volumes[i].bounds_min, volumes[i].bounds_max);
    if (inside.x <= inside.y + margin && inside.x <= 1.0 + margin && inside.y >= -margin) mask |= 1u << i;
  }
  return subgroupOr(mask);
}

/// The extinction of the volumes of a mask.
float volumes_extinction(uint mask, vec3 p_world, vec3 half_world) {
  if (!kHasSeveral) return volume_extinction(volumes[0], 0u, p_world, half_world);
  float sum = 0.0;
  for (uint left = mask; left != 0u; left &= left - 1u) {
    const uint i = uint(findLSB(left));
    sum += volume_extinction(volumes[i], i, p_world, half_world);
  }
  return sum;
}

#endif
