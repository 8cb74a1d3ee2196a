// Lights as indirect light knows them: through shadow maps and the cells of media.
#ifndef INDIRECT_LIGHTS_GLSL
#define INDIRECT_LIGHTS_GLSL
#include "lib/indirect_cells.glsl"
#include "lib/lights.glsl"

layout(scalar, binding = kBindLights) readonly buffer Lights { Light lights[]; };
layout(scalar, push_constant) uniform Push { IndirectParams params; };
layout(binding = kBindMediumMatter) uniform sampler3D medium_matter;
#include "lib/light_visibility.glsl"

/// Deeper media count as opaque.
const float kOpaqueDepth = 12.0;

/// Optical depth of the media from a place [cells] over a distance [cells].
float medium_depth(vec3 p_cells, vec3 direction, float reach) {
  float sum = 0.0;
  for (Dda ray = ray_in_media(params, p_cells, direction, reach); ray.t < ray.t_end && sum < kOpaqueDepth;
       ray = dda_step(ray))
    sum += length_in_cell(ray) * texelFetch(medium_matter, ray.cell, 0).a;
  return sum;
}

#endif
