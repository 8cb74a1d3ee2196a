// Fills two atlases (shared/smoke_volume.h): density and displacement of the noise for rays from the eye, and the
// filtered density for rays to lights. They depend on the time alone, never on the previous frame.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#include "lib/frame.glsl"
#include "lib/erosion.glsl"
#include "lib/smoke_texels.glsl"
#include "shared/noise_advection.h"

layout(local_size_x = 64) in;
layout(binding = kBindDensity) uniform sampler3D density_atlas;
layout(binding = kBindNoiseTile) uniform sampler3D noise_tile;
layout(scalar, binding = kBindCloudParts) readonly buffer Parts { uvec2 parts[]; };
layout(scalar, binding = kBindDisplacements) readonly buffer Displacements { uvec2 displacements[]; };
layout(scalar, binding = kBindCloudMotions) readonly buffer Motions { CloudMotion motions[]; };
layout(scalar, binding = kBindImpulses) readonly buffer Impulses { Impulse impulses[]; };
layout(binding = kBindDensityDisplacement, rgba16f) uniform writeonly image3D density_displacement;
layout(binding = kBindFilteredDensity, rg16f) uniform writeonly image3D filtered_density;
layout(scalar, binding = kBindSlots) readonly buffer Slots { uint slots[]; };
layout(scalar, push_constant) uniform Push { NoiseAdvectionParams params; };

/// Mean density of the free voxels around a texel of value `here`, and whether any voxel around it holds smoke. The
/// texels around are those of its brick: beyond its apron another brick begins, from anywhere.
bool density_around(vec2 here, uint slot, uint local, out float density) {
  const vec3 first = vec3(texel_in_atlas(slot, 0u)), texel = 1.0 / vec3(textureSize(density_atlas, 0));
  vec2 sum = vec2(0.0);
  for (uint i = 0u; i < 8u; ++i) {
    const vec3 corner = vec3(local_texel(local)) + vec3(i & 1u, i >> 1u & 1u, i >> 2u);
    sum += textureLod(density_atlas, (first + clamp(corner, 0.5, float(kBrickTexels) - 0.5)) * texel, 0.0).rg;
  }
  // In a wall, the density in front of it: light grazes walls.
  density = here.g > 0.5 ? here.r : sum.r / max(sum.g, 1e-3);
  return sum.r > 0.0;
}

/// A part's growth at a texel of the brick, and its weight.
vec4 growth_at(uint part, ivec3 local) {
  vec4 sum = vec4(0.0);
  float weight = 0.0;
  for (int i = 0; i < 8; ++i) {
    const float share = growth_share(local, i);
    const uvec2 words = displacements[part * kDisplacementsPerBrick + growth_point(local, i)];
    const vec2 high = unpackHalf2x16(words.y);
    // Outside of the cloud its growth is extrapolated from inside.
    if (high.y > 0.0) sum += share * vec4(unpackHalf2x16(words.x), high.x, 1.0);
    weight += share * high.y;
  }
  return vec4(sum.xyz / max(sum.w, 1e-6), weight);
}

/// Displacement of the noise at a point by the clouds of a slot, blended by weight where they overlap.
vec3 displacement_by_clouds(uint slot, ivec3 local, vec3 p_world) {
  const vec3 one = first_swirl(p_world, frame.look.swirl_width);
  const vec3 other = second_swirl(p_world, frame.look.swirl_width);
  vec4 sum = vec4(0.0);
  const uvec2 range = parts[slot];
  for (uint i = range.x; i < range.x + range.y; ++i) {
    const uvec2 part = parts[params.all_slots + i];
    const CloudMotion motion = motions[part.y];
    const vec4 growth = growth_at(part.x, local);
    const vec3 swirl = frame.look.swirl * (motion.swirl_cos * one + motion.swirl_sin * other);
    sum += cloud_displacement(motion, growth, swirl, frame.smoke.voxel_size);
  }
  return sum.xyz / max(sum.w, 1e-12);
}

/// Displacement of the noise at a point by shots, bodies and explosions. Each thread of the subgroup tests one impulse
/// against the ball around the points of all, so all threads must be active.
vec3 displacement_by_impulses(vec3 p_world) {
  const vec3 low = subgroupMin(p_world), high = subgroupMax(p_world), centre = 0.5 * (low + high);
  const float ball = 1.001 * length(high - centre);
  vec3 sum = vec3(0.0);
  for (uint first = 0u; first < params.impulse_count; first += gl_SubgroupSize) {
    const uint mine = min(first + gl_SubgroupInvocationID, params.impulse_count - 1u);
    const bool near_ball = length(from_segment(impulses[mine], centre)) < impulses[mine].radius + ball;
    const uvec4 near_any = subgroupBallot(first + gl_SubgroupInvocationID < params.impulse_count && near_ball);
    for (uint word = 0u; 32u * word < gl_SubgroupSize; ++word) {
      for (uint bits = near_any[word]; bits != 0u; bits &= bits - 1u) {
        sum += impulse_displacement(impulses[first + 32u * word + uint(findLSB(bits))], p_world);
      }
    }
  }
  return sum;
}

/// Fraction of a density that erosion retains in a texel for rays to lights: that which lets as much light through, on
/// average. From four points of it, the corners of a tetrahedron.
float retained_fraction(float density, vec3 p_world, vec3 displacement) {
  if (frame.look.erosion <= 0.0) return 1.0;
  vec4 remaining;
  for (uint i = 0u; i < 4u; ++i) {
    const vec3 within = (vec3(i & 1u, i >> 1u, (i ^ i >> 1u) & 1u) - 0.5) * (0.5 * frame.smoke.voxel_size);
    const vec4 noise = smoke_noise(noise_tile, frame.look, p_world + within + displacement, frame.time);
    remaining[i] = effective_erode(frame.look, density, noise);
  }
  return effective_density(remaining, frame.look.extinction * frame.smoke.voxel_size) / max(density, 1e-3);
}

void main() {
  // One thread per texel of the listed slots.
  const uint texels = params.slot_count * kTexelsPerBrick, texel = min(gl_GlobalInvocationID.x, texels - 1u);
  const uint slot = slots[params.first_slot + texel / kTexelsPerBrick], local = texel % kTexelsPerBrick;
  const vec3 p_world = world_from_voxel(texel_position(slot, local));
  const vec3 by_impulses = displacement_by_impulses(p_world);  // while all threads are active
  if (gl_GlobalInvocationID.x >= texels) return;

  // Far from smoke there is nothing to displace.
  const ivec3 in_atlas = texel_in_atlas(slot, local);
  const vec2 here = texelFetch(density_atlas, in_atlas, 0).rg;
  const bool is_free = here.g > 0.5;
  const float stored = is_free ? here.r : kInSolid;
  float density;
  if (!density_around(here, slot, local, density)) {
    imageStore(density_displacement, in_atlas, vec4(stored, 0.0, 0.0, 0.0));
    imageStore(filtered_density, in_atlas, vec4(stored, 0.0, 0.0, 0.0));
    return;
  }

  const vec3 displacement = displacement_by_clouds(slot, local_texel(local), p_world) - by_impulses;
  const float retained = retained_fraction(density, p_world, displacement);
  imageStore(density_displacement, in_atlas, vec4(stored, displacement));
  imageStore(filtered_density, in_atlas, vec4(is_free ? here.r * retained : kInSolid, retained, 0.0, 0.0));
}
