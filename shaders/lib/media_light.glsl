// The media of a frame as rays to lights meet them: their optical depths add up. The includer defines the constant
// kMedia, the set of those that are present. Rays from the eye see more (lib/media.glsl).
#ifndef MEDIA_LIGHT_GLSL
#define MEDIA_LIGHT_GLSL
#include "lib/media_set.glsl"
#include "lib/optical_depth.glsl"
#include "lib/volume_depth.glsl"

/// A place, as each medium knows it.
struct MediaPoint {
  vec3 world;
  vec3 smoke;  // in the voxel space of the smoke
};

MediaPoint media_point(vec3 p_world) { return MediaPoint(p_world, smoke_from_world(p_world)); }

/// How finely rays sample the media.
struct DepthSteps {
  float coarse;         // of the smoke (smoke_depth)
  uint count;           // through each volume, of which
  uint first, stride;   // every `stride`-th counts, from `first` on
};

DepthSteps depth_steps(float coarse, uint count) { return DepthSteps(coarse, count, 0u, 1u); }

// Optical depths along the first `distance` metres of a ray, `direction` unit: of all media, and, for what follows the
// ray through one of them in its own way, of the others. Each function states all that it counts, because a driver
// translates all code of a shader, whatever its constants.

float depth_besides_volumes(MediaPoint from, vec3 direction, float distance, DepthSteps steps) {
  float depth = 0.0;
  if (kHasSmoke) depth += smoke_depth(from.smoke, direction, distance, steps.coarse);
  return depth;
}

float depth_besides_smoke(MediaPoint from, vec3 direction, float distance, DepthSteps steps) {
  float depth = 0.0;
  if (kHasVolumes) depth += volumes_depth(from.world, direction, distance, steps.count, steps.first, steps.stride);
  return depth;
}

float media_depth(MediaPoint from, vec3 direction, float distance, DepthSteps steps) {
  float depth = depth_besides_volumes(from, direction, distance, steps);
  if (kHasVolumes) depth += volumes_depth(from.world, direction, distance, steps.count, steps.first, steps.stride);
  return depth;
}

#endif
