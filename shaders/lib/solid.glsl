// Rays through the solid volume. Needs `frame`; the includer defines BINDING_SOLID.
#ifndef SOLID_GLSL
#define SOLID_GLSL
#include "shared/dda.h"
#include "shared/frame.h"

layout(binding = BINDING_SOLID) uniform sampler3D free_texels;

/// The ray between two points of the world as texels of the solid volume, t in texels; from t_begin on to t_end.
Dda solid_ray(vec3 from_world, vec3 to_world, float t_begin, float t_end) {
  const vec3 from = (from_world - frame.solid.origin_world) / frame.solid.texel_size;
  const vec3 to = (to_world - frame.solid.origin_world) / frame.solid.texel_size;
  const float way = length(to - from);
  return dda_begin(from, (to - from) / max(way, 1e-6), ivec3(0), frame.solid.size, 1, t_begin, min(t_end, way));
}

/// Walks to the first solid texel, or to the end of the ray.
Dda to_solid(Dda d) {
  while (d.t < d.t_end && texelFetch(free_texels, d.cell, 0).r > 0.5) d = dda_step(d);
  return d;
}

/// 1 where nothing solid is between two points, else 0. Texels that the way leaves within kSolidEnds of its ends do not
/// count: a surface lies in solid texels, and what shines may lie on one.
float free_way(vec3 from_world, vec3 to_world) {
  const float way = length(to_world - from_world) / frame.solid.texel_size;
  const Dda d = to_solid(solid_ray(from_world, to_world, kSolidEnds, way - kSolidEnds));
  return d.t < d.t_end ? 0.0 : 1.0;
}

/// Where the way from a light first comes to something solid, or `to_world`.
vec3 first_solid(vec3 from_world, vec3 to_world) {
  const Dda d = to_solid(solid_ray(from_world, to_world, kSolidEnds, 1e9));
  const float way = length(to_world - from_world);
  return d.t < d.t_end ? mix(from_world, to_world, d.t * frame.solid.texel_size / way) : to_world;
}

#endif
