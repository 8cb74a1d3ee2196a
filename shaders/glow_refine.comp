// The state of a level of the diffusion from that of the coarser one, interpolated (shared/glow_field.h).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/glow_field.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, binding = kBindGlowState) buffer State { PackedVec3 state[]; };
layout(scalar, push_constant) uniform Push { GlowFieldParams params; };

vec3 coarse_at(ivec3 cell) {
  const int edge = int(kGlowEdge >> (params.level + 1u));
  const ivec3 c = clamp(cell, ivec3(0), ivec3(edge - 1));
  return unpacked(state[first_glow_cell(params.level + 1u) + uint(c.x + edge * (c.y + edge * c.z))]);
}

void main() {
  const uint edge = kGlowEdge >> params.level;
  const uvec3 cell = gl_GlobalInvocationID;
  if (any(greaterThanEqual(cell, uvec3(edge)))) return;
  const vec3 at = 0.5 * (vec3(cell) + 0.5) - 0.5;
  const ivec3 first = ivec3(floor(at));
  const vec3 part = at - vec3(first);
  vec3 sum = vec3(0.0);
  for (uint corner = 0u; corner < 8u; ++corner) {
    const ivec3 side = ivec3(corner & 1u, corner >> 1u & 1u, corner >> 2u);
    const vec3 weights = mix(1.0 - part, part, vec3(side));
    sum += weights.x * weights.y * weights.z * coarse_at(first + side);
  }
  state[first_glow_cell(params.level) + cell.x + edge * (cell.y + edge * cell.z)] = packed_of(sum);
}
