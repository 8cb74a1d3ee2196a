// A part of a bitonic network (Batcher 1968, "Sorting networks and their applications") that sorts particles from back to
// front: all steps within blocks, in shared memory, or one step between them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/particles.h"

layout(constant_id = 0) const uint kWithinBlocks = 1u;
const uint kThreads = 128u;
layout(local_size_x = kThreads) in;
layout(scalar, binding = kBindParticleOrder) buffer Order { uvec2 order[]; };
layout(scalar, push_constant) uniform Push { ParticleList list; };

shared uvec2 block[kParticleBlock];

/// Farther ones first; equally far ones by their number, so that the order is the same on every device.
bool is_before(uvec2 a, uvec2 b) { return a.x > b.x || (a.x == b.x && a.y < b.y); }

/// The first entry of a pair.
uint first_of(uint pair, uint stride) { return 2u * stride * (pair / stride) + pair % stride; }

/// Whether a pair of a span is in the wrong order: every second span is sorted the other way round.
bool is_wrong(uvec2 a, uvec2 b, uint place, uint span) { return (place & span) == 0u ? is_before(b, a) : is_before(a, b); }

void sort_within_blocks() {
  const uint base = gl_WorkGroupID.x * kParticleBlock;
  for (uint i = gl_LocalInvocationID.x; i < kParticleBlock; i += kThreads) block[i] = order[base + i];
  barrier();
  for (uint span = list.first_span; span <= list.last_span; span *= 2u) {
    for (uint stride = min(span, kParticleBlock) / 2u; stride > 0u; stride /= 2u) {
      for (uint pair = gl_LocalInvocationID.x; pair < kParticleBlock / 2u; pair += kThreads) {
        const uint i = first_of(pair, stride);
        const uvec2 a = block[i], b = block[i + stride];
        if (is_wrong(a, b, base + i, span)) {
          block[i] = b;
          block[i + stride] = a;
        }
      }
      barrier();
    }
  }
  for (uint i = gl_LocalInvocationID.x; i < kParticleBlock; i += kThreads) order[base + i] = block[i];
}

void step_between_blocks() {
  const uint pair = gl_GlobalInvocationID.x;
  if (pair >= list.padded_count / 2u) return;
  const uint i = first_of(pair, list.stride);
  const uvec2 a = order[i], b = order[i + list.stride];
  if (is_wrong(a, b, i, list.last_span)) {
    order[i] = b;
    order[i + list.stride] = a;
  }
}

void main() {
  if (kWithinBlocks != 0u)
    sort_within_blocks();
  else
    step_between_blocks();
}
