// In-scattered radiance at every listed texel: what each ray brings, scattered towards the eye. The march then pays one
// fetch a sample, however many lamps there are.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define BINDING_SKY_LIGHT 7
#define BINDING_SOLID 8
#include "lib/lights.glsl"
#include "shared/frame.h"
#include "shared/scattering.h"
#include "shared/smoke_light.h"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Frame { FrameConstants frame; };
layout(scalar, binding = 1) readonly buffer SlotBricks { ivec3 slot_bricks[]; };
layout(scalar, binding = 2) readonly buffer Lights { Light lights[]; };
layout(scalar, binding = 3) readonly buffer Texels { uint texels[]; };
layout(scalar, binding = 4) readonly buffer RayLight { uint ray_light[]; };
layout(scalar, binding = 5) readonly buffer Counters { SmokeLightCounters counters; };
layout(binding = 6, rgba16f) uniform writeonly image3D inscatter;
layout(binding = 9) uniform sampler3D density_atlas;
layout(binding = 10) uniform sampler3D share_atlas;
layout(push_constant, scalar) uniform Push { SmokeLightParams params; };
#include "lib/sky_light.glsl"
#include "lib/smoke_texels.glsl"

/// Mean transmittance out of the smoke, over all directions.
float escape_of(uint first) {
  float escape = 0.0;
  for (uint i = 0u; i < kSkyRays; ++i) escape += exp(-unpackHalf2x16(ray_light[first + i]).x) / float(kSkyRays);
  return escape;
}

/// Radiance from all around of an even sky of radiance 1, were there no level: light that comes straight in, a share p,
/// and light that was scattered on its way, as bright as here and dimmed by the albedo: J = p + albedo (1 - p) J.
/// Without absorption the smoke is as bright as the sky, whatever its density.
vec3 scattered_sky(float p) { return vec3(p) / (1.0 - frame.look.albedo * (1.0 - p)); }

/// How much too bright light of exp(-k depth) is in the mean where it is interpolated between texels that are an optical
/// depth of `step` apart: (x / 2) coth(x / 2) along an axis, x = k step; to the second order 1 + x^2 / 12 in every direction.
vec3 interpolation_excess(vec3 k, float step) { return 1.0 + k * k * (step * step / 12.0); }

void main() {
  for (uint i = gl_GlobalInvocationID.x; i < counters.texels; i += gl_NumWorkGroups.x * 64u) {
    const SmokeTexel texel = smoke_texel(texels[i]);
    const vec3 p_world = world_from_voxel(texel.position_voxel);
    const vec3 to_eye = normalize(frame.camera.eye_world - p_world);
    const uint first = i * params.rays_per_texel;
    const float escape = escape_of(first + frame.light_count);
    const float density = texelFetch(density_atlas, texel.at, 0).r * texelFetch(share_atlas, texel.at, 0).r;
    const float texel_depth = density * frame.look.extinction * frame.volume.voxel_size;
    const vec3 excess = interpolation_excess(vec3(1.0), texel_depth);
    ManyScatterings many = many_scatterings(frame.look, escape);
    many.share *= excess / interpolation_excess(many.decay, texel_depth);
    vec3 lamps = vec3(0.0);
    for (uint k = 0u; k < frame.light_count; ++k) {
      const vec2 depth_lit = unpackHalf2x16(ray_light[first + k]);
      if (depth_lit.y <= 0.0) continue;
      const Incident incident = light_at(lights[k], p_world);
      lamps += incident.irradiance * (depth_lit.y * scattered(frame.look.phase, many, depth_lit.x, -dot(incident.to_light, to_eye)));
    }
    const vec3 sky = frame.sky.ambient * sky_visibility(p_world) * scattered_sky(escape);
    imageStore(inscatter, texel.at, vec4(sky + lamps / excess, 1.0));
  }
}
