// Rays from each listed texel of a brick to a light or to the sky: optical depth of all media and visibility through
// the scene. Neighbouring threads trace to the same light, so that their rays meet the same bricks.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/frame.glsl"
#include "lib/lights.glsl"
#include "shared/smoke_light.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kMedia = 0u;
layout(scalar, binding = kBindLights) readonly buffer Lights { Light lights[]; };
layout(scalar, binding = kBindShadowRays) readonly buffer Pairs { ShadowRays pairs[]; };
layout(scalar, binding = kBindLightRows) readonly buffer Rows { uint rows[]; };
layout(scalar, binding = kBindLightBlocks) writeonly buffer Blocks { uint blocks[]; };
layout(scalar, push_constant) uniform Push { SmokeLightParams params; };
#include "lib/light_visibility.glsl"
#include "lib/low_discrepancy.glsl"
#include "lib/media_light.glsl"
#include "lib/row_texels.glsl"
#include "lib/smoke_texels.glsl"

/// Steps through each volume besides the smoke.
const uint kVolumeSteps = 16u;
/// Points of a voxel at which a light is visible or not.
const uint kVisibilityPoints = 8u;
/// Edge of the cube they fill [voxels]: narrower, steps show; wider, shafts blur.
const float kVisibilityEdge = 1.25;

/// Optical depth from a texel along a unit direction.
float depth_from(vec3 p_voxel, vec3 direction, float distance_m, float coarse) {
  const MediaPoint from = MediaPoint(world_from_voxel(p_voxel), p_voxel);
  return media_depth(from, direction, distance_m, depth_steps(coarse, kVolumeSteps));
}

/// Point i of those at which the visibility of a light is taken, from the centre of the voxel [voxels]: a lattice and
/// its opposites, so that their mean has no side.
vec3 visibility_offset(uint i) {
  const vec3 offset = (lattice_point(i / 2u, vec3(0.5)) - 0.5) * kVisibilityEdge;
  return (i & 1u) == 0u ? offset : -offset;
}

/// Whether a point near a texel is on the texel's side of all surfaces.
bool is_on_side(vec3 texel_voxel, vec3 offset) {
  const vec3 p = texel_voxel + offset, brick = floor(p / float(kBrickVoxels));
  int empty_edge;
  const uint slot = slot_at(frame.smoke.bricks, ivec3(brick), empty_edge);
  return slot == kNoSlot || !is_behind_surface(slot, p - brick * float(kBrickVoxels), -offset);
}

/// Sum of the visibility of a light at the points [first, end).
float visibility_at(Light light, vec3 p_voxel, uint first, uint end) {
  float sum = 0.0;
  for (uint i = first; i < end; ++i) sum += light_visibility(light, world_from_voxel(p_voxel + visibility_offset(i)));
  return sum;
}

/// Mean visibility of a light around a texel. At its centre alone, light would have the steps of the texels along the
/// edges of shafts.
float mean_visibility(Light light, vec3 p_voxel) {
  // Most texels are not at an edge: half of the points agree.
  const uint half_way = kVisibilityPoints / 2u;
  const float some = visibility_at(light, p_voxel, 0u, half_way);
  if (some == 0.0 || some == float(half_way)) return some / float(half_way);
  for (uint i = 0u; i < kVisibilityPoints; ++i)
    if (!is_on_side(p_voxel, visibility_offset(i))) return light_visibility(light, world_from_voxel(p_voxel));
  return (some + visibility_at(light, p_voxel, half_way, kVisibilityPoints)) / float(kVisibilityPoints);
}

/// Visibility of a light at a texel; 0 also where the light is negligible (slightly below the threshold of
/// inscatter.comp). Rays through voxels are for flashes, which last a few frames: they go to the centre.
float significant_visibility(Light light, Incident incident, vec3 p_voxel) {
  if (strongest_of(incident) < 0.99 * least_irradiance(light)) return 0.0;
  if (light.shadow_layer >= kShadowByVoxels) return light_visibility(light, world_from_voxel(p_voxel));
  return mean_visibility(light, p_voxel);
}

void to_light(ShadowRays pair, uint local) {
  const vec3 p_voxel = texel_position(pair.slot, local);
  const Incident incident = light_at(lights[pair.light], world_from_voxel(p_voxel));
  const float lit = significant_visibility(lights[pair.light], incident, p_voxel);
  const float depth = depth_from(p_voxel, incident.to_light, lit > 0.0 ? incident.distance : 0.0, 1.0);
  blocks[pair.block * kTexelsPerBrick + local] = packHalf2x16(vec2(depth, lit));
}

void to_sky(ShadowRays pair, uint local) {
  const vec3 p_voxel = texel_position(pair.slot, local);
  vec2 depths;
  for (uint i = 0u; i < 2u; ++i)
    depths[i] = depth_from(p_voxel, sky_ray(2u * (pair.light - kSkyTarget) + i), 1e4, 2.0);
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
    // Loops that run at most once: a software rasteriser skips loops, but pays for branches that it does not take.
    for (bool now = !sky; now; now = false) to_light(pair, local);
    for (bool now = sky; now; now = false) to_sky(pair, local);
    entry += params.threads;
  } while (entry < entries.y);
}
