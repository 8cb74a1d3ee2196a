// lib/slice_texture.glsl at given points of a volume.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/slice_texture.glsl"

#include "probes.h"

layout(local_size_x = 64) in;
layout(binding = kBindSliceTextures) uniform sampler2D slices;
layout(scalar, binding = kBindProbeIn) readonly buffer Points { vec4 points_uvw[]; };
layout(scalar, binding = kBindProbeOut) writeonly buffer Values { vec4 values[]; };
layout(scalar, push_constant) uniform Push { SliceTexture volume; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= uint(points_uvw.length())) return;
  values[i] = slice_texture_sample(slices, volume, points_uvw[i].xyz);
}
