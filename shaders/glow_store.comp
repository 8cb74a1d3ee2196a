// The solved state of the diffusion, beside what arrives straight (shared/glow_field.h).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/glow_field.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, binding = kBindGlowState) readonly buffer State { PackedVec3 state[]; };
layout(binding = kBindGlowFieldTarget, rgba16f) uniform writeonly image3D field;
layout(scalar, push_constant) uniform Push { GlowFieldParams params; };

void main() {
  const uvec3 cell = gl_GlobalInvocationID;
  const vec3 radiance = unpacked(state[cell.x + kGlowEdge * (cell.y + kGlowEdge * cell.z)]);
  imageStore(field, ivec3(cell) + ivec3(kGlowEdge, 0, params.volume * kGlowEdge), vec4(radiance, 1.0));
}
