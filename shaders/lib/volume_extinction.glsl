// Extinction of the volumes besides the smoke, of all together. The includer defines the constant kMedia.
#ifndef VOLUME_EXTINCTION_GLSL
#define VOLUME_EXTINCTION_GLSL
#include "lib/volume_transfer.glsl"

/// Extinction of volume i at a point [1/m]; with a transfer function that of the segment p_world - half_world to
/// p_world + half_world.
float volume_extinction(VolumeInstance volume, uint i, vec3 p_world, vec3 half_world) {
  const vec3 p_voxel = volume.voxel_from_world * vec4(p_world, 1.0);
  if (any(lessThan(p_voxel, volume.bounds_min)) || any(greaterThan(p_voxel, volume.bounds_max))) return 0.0;
  if (!kHasTransfer) return volume.look.extinction * volume_value(volume.bricks, p_voxel);
  const vec2 values = end_values(volume, p_voxel, volume.voxel_from_world * vec4(half_world, 0.0));
  return volume.look.extinction * matter_of(volume, i, values).density;
}

/// The same of all volumes of the frame.
float volumes_extinction(uint volume_count, vec3 p_world, vec3 half_world) {
  float sum = volume_extinction(volumes[0], 0u, p_world, half_world);
  for (uint i = 1u; i < volume_count; ++i) sum += volume_extinction(volumes[i], i, p_world, half_world);
  return sum;
}

#endif
