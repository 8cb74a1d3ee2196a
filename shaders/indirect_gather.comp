// Light that arrives at each probe, from patches, from the sky, and from media on its path.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/indirect_cells.glsl"
#include "lib/low_discrepancy.glsl"
#include "shared/sky_light.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kMediaInCells = 1u;   // 0: there are none
layout(constant_id = 1) const uint kSmallEmitters = 1u;  // likewise
layout(scalar, binding = kBindIndirectProbes) readonly buffer Probes { uint probes[]; };
layout(scalar, binding = kBindIndirectHits) readonly buffer Hits { uint hits[]; };
layout(scalar, binding = kBindEmitterSamples) readonly buffer Samples { EmitterSample emitter_samples[]; };
layout(scalar, binding = kBindEmitterRays) readonly buffer EmitterRays { EmitterRay emitter_rays[]; };
layout(scalar, binding = kBindPatchRadiance) readonly buffer Radiance { PackedVec3 radiance[]; };
layout(binding = kBindIndirectMedium) uniform sampler3D medium;
layout(binding = kBindIndirectTarget, rgba16f) uniform writeonly image3D target;
layout(scalar, push_constant) uniform Push { IndirectParams params; };

/// Radiance of the media along a ray, and in alpha their transmittance.
vec4 through_media(vec3 p_cells, vec3 direction, float reach) {
  vec3 sum = vec3(0.0);
  float transmittance = 1.0;
  for (Dda ray = ray_in_media(params, p_cells, direction, reach); ray.t < ray.t_end && transmittance > 0.01;
       ray = dda_step(ray)) {
    const vec4 here = texelFetch(medium, ray.cell, 0);
    const float passed = exp(-here.a * length_in_cell(ray));
    sum += transmittance * (1.0 - passed) / max(here.a, 1e-6) * here.rgb;
    transmittance *= passed;
  }
  return vec4(sum, transmittance);
}

/// Where ray i starts in its cell, relative to the middle [cells]: all over it, so that the rays find its mean.
vec3 start_of(uint i) { return lattice_point(i, vec3(0.5)) - 0.5; }

void main() {
  const uint probe = params.first_probe + gl_GlobalInvocationID.x;
  if (probe >= params.end_probe) return;
  const ivec3 cell = cell_at(frame.indirect, probes[probe]);
  const uint phase = probe_phase(cell);
  vec3 sums[6] = vec3[6](vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
  vec3 ahead = vec3(0.0), behind = vec3(0.0);  // sums of the cosines
  for (uint i = 0u; i < kProbeRays; ++i) {
    const vec3 direction = probe_direction(i, phase);
    const uint hit = hits[i * params.probe_count + probe];
    vec3 light = hit_patch(hit) == kSkyPatch ? frame.sky.ambient * sky_shape(direction.y)
                                             : unpacked(radiance[hit_patch(hit)]);
    if (kMediaInCells != 0u) {
      const vec3 start = start_of(i);
      const vec4 media = through_media(vec3(cell) + 0.5 + start, direction, hit_cells(hit) - dot(start, direction));
      light = media.rgb + media.a * light;
    }
    const vec3 up = max(direction, vec3(0.0)), down = max(-direction, vec3(0.0));
    ahead += up;
    behind += down;
    for (uint axis = 0u; axis < 3u; ++axis) {
      sums[2u * axis] += up[axis] * light;
      sums[2u * axis + 1u] += down[axis] * light;
    }
  }
  for (uint i = 0u; kSmallEmitters != 0u && i < kEmitterRays; ++i) {
    const EmitterRay ray = emitter_rays[i * params.probe_count + probe];
    if (ray.weight <= 0.0) continue;
    const EmitterSample emitter = emitter_samples[ray.emitter_sample];
    const vec3 start = vec3(cell) + 0.5, path = indirect_from_world(unpacked(emitter.position_world)) - start;
    const float reach = max(length(path), 1e-6);
    const vec3 direction = path / reach;
    vec3 light = ray.weight * unpacked(emitter.radiance);
    if (kMediaInCells != 0u) light *= through_media(start, direction, reach).a;
    const vec3 up = max(direction, vec3(0.0)), down = max(-direction, vec3(0.0));
    for (uint axis = 0u; axis < 3u; ++axis) {
      sums[2u * axis] += up[axis] * light;
      sums[2u * axis + 1u] += down[axis] * light;
    }
  }
  for (uint slab = 0u; slab < kLightSlabs; ++slab) {
    const float cosines = (slab & 1u) == 0u ? ahead[slab >> 1u] : behind[slab >> 1u];
    imageStore(target, cell + ivec3(0, 0, int(slab) * frame.indirect.size.z), vec4(sums[slab] / cosines, 1.0));
  }
}
