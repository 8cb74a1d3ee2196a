// In-scattered radiance at every listed texel of a brick: the light of each ray, scattered towards the eye. The march
// then takes one fetch per sample, however many lights there are.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/frame.glsl"
#include "lib/camera.glsl"
#include "lib/lights.glsl"
#include "shared/light_side.h"
#include "shared/scattering.h"
#include "shared/smoke_light.h"

layout(local_size_x = 64) in;
layout(scalar, binding = kBindLights) readonly buffer Lights { Light lights[]; };
layout(scalar, binding = kBindLightRows) readonly buffer Rows { uint rows[]; };
layout(scalar, binding = kBindLightBlocks) readonly buffer Blocks { uint blocks[]; };
layout(scalar, binding = kBindLightGathers) readonly buffer Bricks { LightGather bricks[]; };
layout(binding = kBindInscatter, rgba16f) uniform writeonly image3D inscatter;
layout(binding = kBindLightSide, rgba16f) uniform writeonly image3D light_side;
layout(scalar, binding = kBindBrickLights) readonly buffer BrickLights { uvec2 brick_lights[]; };
layout(scalar, push_constant) uniform Push { SmokeLightParams params; };
#include "lib/indirect_light.glsl"
#include "lib/optical_depth.glsl"
#include "lib/row_texels.glsl"
#include "lib/sky_light.glsl"
#include "lib/smoke_texels.glsl"

/// Means over all directions.
struct SkyThroughSmoke {
  float escape;  // transmittance out of the smoke
  vec2 seen;     // seen_around, through it
};

SkyThroughSmoke sky_through_smoke(uint block, uint local, vec3 p_world) {
  const vec4 around = sky_around(p_world);
  SkyThroughSmoke sum = SkyThroughSmoke(0.0, vec2(0.0));
  for (uint k = 0u; k < kSkyPages; ++k) {
    const vec2 passed = exp(-unpackHalf2x16(blocks[(block + k) * kTexelsPerBrick + local]));
    sum.escape += passed.x + passed.y;
    sum.seen += passed.x * seen_around(around, sky_ray(2u * k)) +
                passed.y * seen_around(around, sky_ray(2u * k + 1u));
  }
  return SkyThroughSmoke(sum.escape / float(kSkyRays), sum.seen / float(kSkyRays));
}

/// Mean overestimate of exp(-k depth) by linear interpolation between texels an optical depth of `step` apart:
/// (x / 2) coth(x / 2) along an axis, x = k step; to second order 1 + x^2 / 12 in every direction.
vec3 interpolation_excess(vec3 k, float step) { return 1.0 + k * k * (step * step / 12.0); }

struct ScatteredLights {
  vec3 once, often;
  vec3 on_ground;  // irradiance of suns on a level surface here, without smoke
  vec3 side;  // sum of the directions to the lights, each times the sum of the channels of its light
};

/// Light of all lights of a brick at a texel, scattered towards the eye.
ScatteredLights scattered_lights(LightGather brick, uint local, vec3 p_world, vec3 to_eye, ManyScatterings many) {
  ScatteredLights sum = ScatteredLights(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
  for (uint k = 0u; k < brick.light_count; ++k) {
    const uvec2 light = brick_lights[brick.first_light + k];
    const vec2 depth_lit = unpackHalf2x16(blocks[light.y * kTexelsPerBrick + local]);
    if (depth_lit.y <= 0.0) continue;
    const Incident incident = light_at(lights[light.x], p_world);
    if (is_negligible(lights[light.x], incident)) continue;
    const float cos_angle = -dot(incident.to_light, to_eye);
    const vec3 arriving = incident.irradiance * depth_lit.y;
    const vec3 once = arriving * (exp(-depth_lit.x) * phase_value(frame.look.phase, cos_angle));
    const vec3 often = arriving * scattered_often(many, depth_lit.x, cos_angle);
    if (lights[light.x].kind == kLightDirectional) sum.on_ground += arriving * max(incident.to_light.y, 0.0);
    sum.once += once;
    sum.often += often;
    // What is scattered often depends less on the depth.
    sum.side += incident.to_light * dot(once + many.decay * often, vec3(1.0));
  }
  return sum;
}

/// The light of all that is not a light itself, or has been scattered before.
vec3 indirect_at(vec3 p_world, vec3 to_eye, vec3 formula, float escape) {
  const float g = mean_cosine(frame.look.phase);
  const vec3 detail = detail_in_cells(p_world, frame.look.albedo, g, frame.look.multiple_scattering, escape);
  return refined_by_formula(scattered_field(indirect_field(p_world), g, to_eye), formula_in_cells(p_world), formula,
                            detail);
}

/// The light_side of a texel, whose in-scatter is `all`.
vec4 light_side_at(vec3 p_voxel, vec3 side, vec3 all) {
  const float fraction = length(side) / max(all.r + all.g + all.b, 1e-9);
  if (fraction <= 0.0) return vec4(0.0);
  const vec3 towards = normalize(side);
  float whole = 0.0, cut = 0.0;
  for (uint i = 0u; i < kSideSamples; ++i) {
    const MeanSmoke smoke = mean_smoke_at(p_voxel + towards * side_sample(i));
    whole += smoke.density;
    if (smoke.density > 0.0) cut += smoke.density * remaining_in_cell(smoke.slot, smoke.local_voxel);
  }
  // The march does not know the holes on the path: where they cut the smoke, it replaces as much less.
  const float replaced = whole > 0.0 ? min(fraction, 1.0) * cut / whole : 0.0;
  return vec4(towards * replaced, whole * side_depth(frame.look.extinction, frame.smoke.voxel_size));
}

void light_texel(LightGather brick, uint local) {
  const ivec3 at = texel_in_atlas(brick.slot, local);
  const vec3 p_world = world_from_voxel(texel_position(brick.slot, local));
  const vec3 to_eye = normalize(to_camera(frame.camera, p_world));
  const SkyThroughSmoke sky = sky_through_smoke(brick.sky_page, local, p_world);
  const float density = max(texelFetch(filtered_density_atlas, at, 0).r, 0.0);
  const float texel_depth = density * frame.look.extinction * frame.smoke.voxel_size;
  const vec3 excess = interpolation_excess(vec3(1.0), texel_depth);
  ManyScatterings many = multiple_scattering(frame.look, sky.escape);
  many.fraction *= excess / interpolation_excess(many.decay, texel_depth);
  const ScatteredLights lights = scattered_lights(brick, local, p_world, to_eye, many);
  vec3 light = lights.once / excess;
  if (frame.indirect.bounces > 0u)
    light += indirect_at(p_world, to_eye, lights.often / excess, sky.escape);
  else
    light += lights.often / excess +
             scattered_sky(frame.look.albedo, frame.look.multiple_scattering, mean_cosine(frame.look.phase),
                           sky.escape, radiance_around(sky.seen, lights.on_ground));
  imageStore(inscatter, at, vec4(light, 1.0));
  if (frame.look.erosion > 0.0)
    imageStore(light_side, at, light_side_at(texel_position(brick.slot, local), lights.side, light * excess));
}

void main() {
  const uint number = gl_WorkGroupID.y + kLightGroups * gl_WorkGroupID.z;
  if (number >= params.count) return;
  const LightGather brick = bricks[params.first + number];
  const uvec2 entries = row_entries(brick.row, brick.texels);
  uint entry = entries.x + gl_GlobalInvocationID.x;
  if (entry >= entries.y) return;
  do {
    light_texel(brick, row_texel(brick.row, brick.texels, entry));
    entry += params.threads;
  } while (entry < entries.y);
}
