// Rays through the solid volume. Needs `frame`; the includer defines BINDING_SOLID.
#ifndef SOLID_GLSL
#define SOLID_GLSL
#include "shared/dda.h"
#include "shared/frame.h"

layout(binding = BINDING_SOLID) uniform sampler3D free_texels;

/// 1 where nothing solid is between two points, else 0. Texels that the way leaves within kSolidEnds of its ends do not
/// count: a surface lies in solid texels, and what shines may lie on one.
float free_way(vec3 from_world, vec3 to_world) {
  const vec3 from = (from_world - frame.solid.origin_world) / frame.solid.texel_size;
  const vec3 to = (to_world - frame.solid.origin_world) / frame.solid.texel_size;
  const float way = length(to - from);
  Dda d = dda_begin(from, (to - from) / max(way, 1e-6), ivec3(0), frame.solid.size, 1, kSolidEnds, way - kSolidEnds);
  float free = 1.0;
  while (d.t < d.t_end) {
    if (texelFetch(free_texels, d.cell, 0).r < 0.5) {
      free = 0.0;
      break;
    }
    d = dda_step(d);
  }
  return free;
}

#endif
