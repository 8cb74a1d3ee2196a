// Light that arrives at each probe, from patches, from the sky, and from media on its path.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/indirect_cells.glsl"
#include "shared/sky_light.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kMediaInCells = 1u;  // 0: there are none
layout(scalar, binding = kBindIndirectProbes) readonly buffer Probes { uint probes[]; };
layout(scalar, binding = kBindIndirectHits) readonly buffer Hits { uint hits[]; };
layout(scalar, binding = kBindPatchRadiance) readonly buffer Radiance { vec3 radiance[]; };
layout(binding = kBindIndirectMedium) uniform sampler3D medium;
layout(binding = kBindIndirectTarget, rgba16f) uniform writeonly image3D target;
layout(scalar, push_constant) uniform Push { IndirectParams params; };

/// Radiance of opaque media of this scattered radiance per metre and extinction.
vec3 scattered_by(vec4 media) { return media.rgb / max(media.a, 1e-6); }

/// Radiance of the media along a ray from the border of its cell over a number of cells, and in alpha their
/// transmittance.
vec4 through_media(vec3 p_cells, vec3 direction, float reach) {
  const vec2 span = span_in_media(params, p_cells, direction, 0.5, reach);
  if (span.y <= span.x) return vec4(0.0, 0.0, 0.0, 1.0);
  const float steps = ceil(span.y - span.x), ds = (span.y - span.x) / steps;
  vec3 sum = vec3(0.0);
  float transmittance = 1.0;
  for (float i = 0.5; i < steps && transmittance > 0.01; ++i) {
    const vec3 p = p_cells + direction * (span.x + i * ds);
    const vec4 here = textureLod(medium, p / vec3(frame.indirect.size), 0.0);
    const float passed = exp(-here.a * ds * frame.indirect.cell_size);
    sum += transmittance * (1.0 - passed) * scattered_by(here);
    transmittance *= passed;
  }
  return vec4(sum, transmittance);
}

void main() {
  const uint probe = params.first_probe + gl_GlobalInvocationID.x;
  if (probe >= params.end_probe) return;
  const ivec3 cell = cell_at(frame.indirect, probes[probe]);
  const uint phase = probe_phase(cell);
  const vec4 own = kMediaInCells != 0u ? texelFetch(medium, cell, 0) : vec4(0.0);
  const float leaves = out_of_cell(own.a);
  vec3 sums[6] = vec3[6](vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
  float escape = kMediaInCells != 0u ? 0.0 : float(kProbeRays);
  vec3 ahead = vec3(0.0), behind = vec3(0.0);  // sums of the cosines
  for (uint i = 0u; i < kProbeRays; ++i) {
    const vec3 direction = probe_direction(i, phase);
    const uint hit = hits[i * params.probe_count + probe];
    vec3 light = hit_patch(hit) == kSkyPatch ? frame.sky.ambient * sky_shape(direction.y) : radiance[hit_patch(hit)];
    if (kMediaInCells != 0u) {
      const vec4 media = through_media(vec3(cell) + 0.5, direction, hit_cells(hit));
      light = mix(scattered_by(own), media.rgb + media.a * light, leaves);
      escape += leaves * media.a;
    }
    const vec3 up = max(direction, vec3(0.0)), down = max(-direction, vec3(0.0));
    ahead += up;
    behind += down;
    for (uint axis = 0u; axis < 3u; ++axis) {
      sums[2u * axis] += up[axis] * light;
      sums[2u * axis + 1u] += down[axis] * light;
    }
  }
  for (uint slab = 0u; slab < 6u; ++slab) {
    const float cosines = (slab & 1u) == 0u ? ahead[slab >> 1u] : behind[slab >> 1u];
    imageStore(target, cell + ivec3(0, 0, int(slab) * frame.indirect.size.z), vec4(sums[slab] / cosines, 1.0));
  }
  imageStore(target, cell + ivec3(0, 0, int(kEscapeSlab) * frame.indirect.size.z),
             vec4(escape / float(kProbeRays), 0.0, 0.0, 1.0));
}
