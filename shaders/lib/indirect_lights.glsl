// Lights as indirect light knows them: through shadow maps and the cells of media.
#ifndef INDIRECT_LIGHTS_GLSL
#define INDIRECT_LIGHTS_GLSL
#include "lib/indirect_cells.glsl"
#include "lib/lights.glsl"

layout(scalar, binding = kBindLights) readonly buffer Lights { Light lights[]; };
layout(scalar, push_constant) uniform Push { IndirectParams params; };
layout(binding = kBindMediumMatter) uniform sampler3D medium_matter;
#include "lib/light_visibility.glsl"

/// Optical depth of the media from a point over a distance [m], from `nearest` cells on.
float medium_depth(vec3 p_world, vec3 direction, float distance_m, float nearest) {
  const vec3 p = indirect_from_world(p_world);
  const vec3 inverse = 1.0 / (direction + vec3(equal(direction, vec3(0.0))) * 1e-6);
  const vec3 a = (vec3(params.media_low) - p) * inverse, b = (vec3(params.media_high) - p) * inverse;
  const vec3 near = min(a, b), far = max(a, b);
  const float begin = max(max(near.x, near.y), max(near.z, nearest));
  const float end = min(min(far.x, far.y), min(far.z, distance_m / frame.indirect.cell_size));
  if (end <= begin) return 0.0;
  const float steps = ceil(end - begin), ds = (end - begin) / steps;
  float sum = 0.0;
  for (float i = 0.5; i < steps; ++i)
    sum += textureLod(medium_matter, (p + direction * (begin + i * ds)) / vec3(frame.indirect.size), 0.0).a;
  return sum * ds * frame.indirect.cell_size;
}

#endif
