// For every listed texel and every lamp: whether the scene lets light through; and a list of the rays that are left.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define BINDING_SOLID 9
#include "lib/lights.glsl"
#include "shared/frame.h"
#include "shared/smoke_light.h"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Frame { FrameConstants frame; };
layout(scalar, binding = 1) readonly buffer SlotBricks { ivec3 slot_bricks[]; };
layout(scalar, binding = 2) readonly buffer Lights { Light lights[]; };
layout(scalar, binding = 3) readonly buffer Views { ShadowView sun; };
layout(binding = 4) uniform sampler2DArrayShadow shadows;
layout(scalar, binding = 5) readonly buffer Texels { uint texels[]; };
layout(scalar, binding = 6) writeonly buffer Rays { uint rays[]; };
layout(scalar, binding = 7) writeonly buffer RayLight { uint ray_light[]; };
layout(scalar, binding = 8) buffer Counters { SmokeLightCounters counters; };
layout(push_constant, scalar) uniform Push { SmokeLightParams params; };
#include "lib/light_share.glsl"
#include "lib/smoke_texels.glsl"

shared uint group_count;
shared uint group_first;

/// Share of a lamp's light that the scene lets through to a point; 0 too where the lamp is too weak to be seen.
float lamp_light(Light light, vec3 p_world) {
  const Incident incident = light_at(light, p_world);
  if (max(incident.irradiance.r, max(incident.irradiance.g, incident.irradiance.b)) < 1e-4) return 0.0;
  return light_share(light, p_world);
}

void main() {
  const uint count = counters.texels * params.rays_per_texel;
  for (uint first = gl_WorkGroupID.x * 64u; first < count; first += gl_NumWorkGroups.x * 64u) {
    const uint at = first + gl_LocalInvocationID.x;
    float lit = 0.0;
    if (at < count) {
      const uint ray = at % params.rays_per_texel;
      const vec3 p_world = world_from_voxel(smoke_texel(texels[at / params.rays_per_texel]).position_voxel);
      lit = ray < frame.light_count ? lamp_light(lights[ray], p_world) : 1.0;
      ray_light[at] = packHalf2x16(vec2(0.0, lit));
    }
    if (gl_LocalInvocationID.x == 0u) group_count = 0u;
    barrier();
    const uint rank = lit > 0.0 ? atomicAdd(group_count, 1u) : 0u;
    barrier();
    if (gl_LocalInvocationID.x == 0u && group_count > 0u) group_first = atomicAdd(counters.rays, group_count);
    barrier();
    if (lit > 0.0) rays[group_first + rank] = at;
    barrier();
  }
}
