// Rays through the solid volume.
#ifndef SOLID_GLSL
#define SOLID_GLSL
#include "lib/frame.glsl"
#include "shared/dda.h"

layout(binding = kBindSolidTexels) uniform sampler3D free_texels;

/// The ray between two points in world space, in texels of the solid volume, for t in [t_begin, t_end) texels.
Dda solid_ray(vec3 from_world, vec3 to_world, float t_begin, float t_end) {
  const vec3 from = (from_world - frame.solid.origin_world) / frame.solid.texel_size;
  const vec3 to = (to_world - frame.solid.origin_world) / frame.solid.texel_size;
  const float reach = length(to - from);
  const vec3 direction = (to - from) / max(reach, 1e-6);
  return dda_begin(from, direction, ivec3(0), frame.solid.size, 1, t_begin, min(t_end, reach));
}

/// Advances to the first solid texel, or to the end of the ray.
Dda to_solid(Dda d) {
  while (d.t < d.t_end && texelFetch(free_texels, d.cell, 0).r > 0.5) d = dda_step(d);
  return d;
}

/// 1 where no solid lies between two points, else 0. Ignores texels within kSolidEnds of the ends: a surface lies
/// inside solid texels, and a light may sit on one.
float segment_visibility(vec3 from_world, vec3 to_world) {
  const float reach = length(to_world - from_world) / frame.solid.texel_size;
  const Dda d = to_solid(solid_ray(from_world, to_world, kSolidEnds, reach - kSolidEnds));
  return d.t < d.t_end ? 0.0 : 1.0;
}

/// The first solid point on a ray from a light, or `to_world`.
vec3 first_solid(vec3 from_world, vec3 to_world) {
  const Dda d = to_solid(solid_ray(from_world, to_world, kSolidEnds, 1e9));
  const float reach = length(to_world - from_world);
  return d.t < d.t_end ? mix(from_world, to_world, d.t * frame.solid.texel_size / reach) : to_world;
}

#endif
