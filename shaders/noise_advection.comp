// For each texel of the smoke's bricks: the medium (shared/smoke_volume.h), density and how far the noise there has been
// carried, for the eye's rays; and the share of the density that the noise leaves in the mean of the texel, for those of
// light. They depend on the moment alone, never on the frame before.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#include "lib/erosion.glsl"
#include "lib/noise.glsl"
#include "shared/noise_advection.h"
#include "shared/frame.h"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) uniform Frame { FrameConstants frame; };
layout(scalar, binding = 1) readonly buffer SlotBricks { ivec3 slot_bricks[]; };
layout(binding = 2) uniform sampler3D density_atlas;
layout(binding = 3) uniform sampler3D noise_tile;
layout(scalar, binding = 4) readonly buffer Parts { uvec2 parts[]; };
layout(scalar, binding = 5) readonly buffer Displacements { uvec2 displacements[]; };
layout(scalar, binding = 6) readonly buffer Motions { CloudMotion motions[]; };
layout(scalar, binding = 7) readonly buffer Impulses { Impulse impulses[]; };
layout(binding = 8, rgba16f) uniform writeonly image3D medium;
layout(binding = 9, rg16f) uniform writeonly image3D filtered_density;
layout(scalar, binding = 10) readonly buffer Slots { uint slots[]; };
layout(push_constant, scalar) uniform Params { NoiseAdvectionParams params; };

/// Rolls repeat after this many of their widths.
const int kSwirlCells = 64;

/// Density of the free voxels around a texel that holds `here`, and whether any voxel around it holds smoke at all.
bool density_around(vec2 here, ivec3 atlas_texel, out float density) {
  const vec3 texel = 1.0 / vec3(textureSize(density_atlas, 0));
  vec2 sum = vec2(0.0);
  for (uint i = 0u; i < 8u; ++i) {
    const vec3 offset = vec3(i & 1u, i >> 1u & 1u, i >> 2u);
    sum += textureLod(density_atlas, (vec3(atlas_texel) + offset) * texel, 0.0).rg;
  }
  // In a wall, what stands before it: light grazes walls.
  density = here.g > 0.5 ? here.r : sum.r / max(sum.g, 1e-3);
  return sum.r > 0.0;
}

/// A part's growth at a texel of the brick, and its weight.
vec4 growth_at(uint part, ivec3 local) {
  const ivec3 low = local >> 1;
  const vec3 f = 0.5 * vec3(local & 1);
  vec4 sum = vec4(0.0);
  float weight = 0.0;
  for (int i = 0; i < 8; ++i) {
    const ivec3 corner = ivec3(i & 1, i >> 1 & 1, i >> 2), at = low + corner;
    const vec3 shares = mix(1.0 - f, f, vec3(corner));
    const float share = shares.x * shares.y * shares.z;
    const uvec2 words = displacements[part * kDisplacementsPerBrick + uint(at.x + kDisplacementPoints * (at.y + kDisplacementPoints * at.z))];
    const vec2 high = unpackHalf2x16(words.y);
    // Where the cloud is not, its growth is that of where it is.
    if (high.y > 0.0) sum += share * vec4(unpackHalf2x16(words.x), high.x, 1.0);
    weight += share * high.y;
  }
  return vec4(sum.xyz / max(sum.w, 1e-6), weight);
}

/// How far the clouds of a slot carry the noise at a point: each its way, where they meet by their shares.
vec3 carried_by_clouds(uint slot, ivec3 local, vec3 p_world) {
  const float width = kSwirlCells * frame.look.swirl_width;
  const vec3 one = curl_noise(p_world / width, kSwirlCells, 11u), other = curl_noise(p_world / width, kSwirlCells, 21u);
  vec4 sum = vec4(0.0);
  const uvec2 range = parts[slot];
  for (uint i = range.x; i < range.x + range.y; ++i) {
    const uvec2 part = parts[params.all_slots + i];
    const CloudMotion motion = motions[part.y];
    const vec4 growth = growth_at(part.x, local);
    const vec3 swirl = frame.look.swirl * (motion.swirl_cos * one + motion.swirl_sin * other);
    // Where a cloud has not come yet it moves nothing that is there.
    const float ahead = motion.front - length(growth.xyz) / frame.volume.voxel_size;
    const float there = clamp(ahead / max(0.25 * motion.front, 2.0), 1e-5, 1.0);
    sum += motion.weight * growth.w * there * vec4(motion.grown * growth.xyz + swirl, 1.0);
  }
  return sum.xyz / max(sum.w, 1e-12);
}

/// From the nearest point of a push's way to a point.
vec3 from_way(Impulse push, vec3 p_world) {
  const vec3 way = push.to_world - push.from_world, from = p_world - push.from_world;
  return from - way * clamp(dot(from, way) / max(dot(way, way), 1e-9), 0.0, 1.0);
}

/// How far shots, bodies and explosions carry the noise at a point: of those that come near the ball around the points of
/// the subgroup, whose threads ask one each.
vec3 pushed(vec3 p_world) {
  const vec3 low = subgroupMin(p_world), high = subgroupMax(p_world), centre = 0.5 * (low + high);
  const float ball = 1.001 * length(high - centre);
  vec3 sum = vec3(0.0);
  for (uint first = 0u; first < params.impulse_count; first += gl_SubgroupSize) {
    const uint mine = min(first + gl_SubgroupInvocationID, params.impulse_count - 1u);
    const bool near_some = length(from_way(impulses[mine], centre)) < impulses[mine].radius + ball;
    const uvec4 asked = subgroupBallot(first + gl_SubgroupInvocationID < params.impulse_count && near_some);
    for (uint word = 0u; 32u * word < gl_SubgroupSize; ++word) {
      for (uint bits = asked[word]; bits != 0u; bits &= bits - 1u) {
        const Impulse push = impulses[first + 32u * word + uint(findLSB(bits))];
        const vec3 apart = from_way(push, p_world);
        const float near = max(0.0, 1.0 - dot(apart, apart) / (push.radius * push.radius));
        sum += near * near * (push.along + push.outward * apart / push.radius);
      }
    }
  }
  return sum;
}

void main() {
  const uint texels = params.slot_count * kTexelsPerBrick, texel = min(gl_GlobalInvocationID.x, texels - 1u);
  const uint slot = slots[params.first_slot + texel / kTexelsPerBrick];
  const uint at = texel % kTexelsPerBrick;
  const ivec3 local = ivec3(at % 10u, at / 10u % 10u, at / 100u);
  const vec3 p_voxel = vec3(slot_bricks[slot] * kBrickVoxels + local) - 0.5;
  const vec3 p_world = frame.volume.origin_world + p_voxel * frame.volume.voxel_size;
  const vec3 pushed_m = pushed(p_world);  // while all threads are there
  if (gl_GlobalInvocationID.x >= texels) return;

  const uvec3 bricks = uvec3(frame.volume.atlas_bricks);
  const uvec3 corner = uvec3(slot % bricks.x, slot / bricks.x % bricks.y, slot / (bricks.x * bricks.y)) * uint(kBrickTexels);
  const ivec3 atlas_texel = ivec3(corner) + local;
  const vec2 here = texelFetch(density_atlas, atlas_texel, 0).rg;
  const float held = here.g > 0.5 ? here.r : kInSolid;
  float density;
  if (!density_around(here, atlas_texel, density)) {
    imageStore(medium, atlas_texel, vec4(held, 0.0, 0.0, 0.0));
    imageStore(filtered_density, atlas_texel, vec4(held, 0.0, 0.0, 0.0));
    return;
  }

  const vec3 carried = carried_by_clouds(slot, local, p_world) - pushed_m;
  // The mean of the texel: four points of it, at the corners of a tetrahedron.
  float share = 1.0;
  if (frame.look.erosion > 0.0) {
    float left = 0.0;
    for (uint i = 0u; i < 4u; ++i) {
      const vec3 within = (vec3(i & 1u, i >> 1u, (i ^ i >> 1u) & 1u) - 0.5) * (0.5 * frame.volume.voxel_size);
      left += 0.25 * erode(frame.look, density, smoke_noise(noise_tile, frame.look, p_world + within + carried, frame.time));
    }
    share = left / max(density, 1e-3);
  }
  imageStore(medium, atlas_texel, vec4(held, carried));
  imageStore(filtered_density, atlas_texel, vec4(here.g > 0.5 ? here.r * share : kInSolid, share, 0.0, 0.0));
}
