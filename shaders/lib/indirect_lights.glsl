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
  const vec2 span = span_in_media(params, p, direction, nearest, distance_m / frame.indirect.cell_size);
  if (span.y <= span.x) return 0.0;
  const float steps = ceil(span.y - span.x), ds = (span.y - span.x) / steps;
  float sum = 0.0;
  for (float i = 0.5; i < steps; ++i)
    sum += textureLod(medium_matter, (p + direction * (span.x + i * ds)) / vec3(frame.indirect.size), 0.0).a;
  return sum * ds * frame.indirect.cell_size;
}

#endif
