// What smoke and scene leave of light on its way from a light, or from the sky, to each texel of a brick. Neighbours ask for the
// same, so that their rays meet the same bricks.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define BINDING_PAGES 5
#define BINDING_CELLS 7
#define BINDING_BOUNDARY 8
#define BINDING_CORNERS 9
#define BINDING_HOLE_CELLS 10
#define BINDING_SOLID 11
#include "lib/lights.glsl"
#include "shared/frame.h"
#include "shared/smoke_light.h"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) uniform Frame { FrameConstants frame; };
layout(scalar, binding = 1) readonly buffer SlotBricks { ivec3 slot_bricks[]; };
layout(scalar, binding = 2) readonly buffer Lights { Light lights[]; };
layout(scalar, binding = 3) readonly buffer Views { ShadowView sun; };
layout(binding = 4) uniform sampler2DArrayShadow shadows;
layout(binding = 6) uniform sampler3D filtered_density_atlas;
layout(scalar, binding = 12) readonly buffer Pairs { ShadowRays pairs[]; };
layout(scalar, binding = 13) readonly buffer Rows { uint rows[]; };
layout(scalar, binding = 14) writeonly buffer Blocks { uint blocks[]; };
layout(push_constant, scalar) uniform Impulse { SmokeLightParams params; };
#include "lib/light_visibility.glsl"
#include "lib/optical_depth.glsl"
#include "lib/row_texels.glsl"
#include "lib/smoke_texels.glsl"

/// Share of a light's light that the scene lets through to a point; 0 too where the light is too weak to be seen
/// (a little less than where inscatter.comp leaves it out).
float light_contribution(Light light, Incident incident, vec3 p_world) {
  if (max(incident.irradiance.r, max(incident.irradiance.g, incident.irradiance.b)) < 0.99 * kLeastIrradiance) return 0.0;
  return light_visibility(light, p_world);
}

void to_light(ShadowRays pair, uint local) {
  const vec3 p_voxel = texel_position(pair.slot, local), p_world = world_from_voxel(p_voxel);
  const Incident incident = light_at(lights[pair.light], p_world);
  const float lit = light_contribution(lights[pair.light], incident, p_world);
  const float depth = optical_depth(p_voxel, incident.to_light, lit > 0.0 ? incident.distance : 0.0, 1.0);
  blocks[pair.block * kTexelsPerBrick + local] = packHalf2x16(vec2(depth, lit));
}

void to_sky(ShadowRays pair, uint local) {
  const vec3 p_voxel = texel_position(pair.slot, local);
  vec2 depths;
  for (uint i = 0u; i < 2u; ++i) depths[i] = optical_depth(p_voxel, sky_ray(2u * (pair.light - kSkyTarget) + i), 1e4, 2.0);
  blocks[pair.block * kTexelsPerBrick + local] = packHalf2x16(depths);
}

void main() {
  const uint number = gl_WorkGroupID.y + kLightGroups * gl_WorkGroupID.z;
  if (number >= params.count) return;
  const ShadowRays pair = pairs[params.first + number];
  const uvec2 entries = row_entries(pair.row, pair.texels);
  const bool sky = pair.light >= kSkyTarget;
  uint entry = entries.x + gl_GlobalInvocationID.x;
  if (entry >= entries.y) return;
  do {
    const uint local = row_texel(pair.row, pair.texels, entry);
    // Loops that run at most once: a software rasteriser pays for branches that it does not take, not for loops.
    for (bool now = !sky; now; now = false) to_light(pair, local);
    for (bool now = sky; now; now = false) to_sky(pair, local);
    entry += params.threads;
  } while (entry < entries.y);
}
