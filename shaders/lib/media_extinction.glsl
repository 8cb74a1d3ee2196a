// The extinction of the media of a frame at a point, as light meets them. The includer defines the constant kMedia, and
// enables GL_KHR_shader_subgroup_arithmetic.
#ifndef MEDIA_EXTINCTION_GLSL
#define MEDIA_EXTINCTION_GLSL
#include "lib/media_light.glsl"
#include "lib/volume_extinction.glsl"

/// What a segment may meet.
struct MediaAlong {
  uint volumes;  // volumes_along
};

MediaAlong media_along(vec3 begin_world, vec3 end_world) {
  return MediaAlong(kHasVolumes ? volumes_along(begin_world, end_world) : 0u);
}

/// Extinction of all media [1/m] from p_world - half_world to p_world + half_world, which is in the segment.
float media_extinction(MediaAlong along, vec3 p_world, vec3 half_world) {
  float sum = 0.0;
  if (kHasVolumes) sum += volumes_extinction(along.volumes, p_world, half_world);
  if (kHasSmoke) sum += smoke_extinction(smoke_from_world(p_world));
  return sum;
}

#endif
