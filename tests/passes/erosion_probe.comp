// Density after erosion at given noises.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/erosion.glsl"

#include "probes.h"

layout(local_size_x = 64) in;
layout(scalar, binding = kBindProbeIn) readonly buffer Noises { vec4 noises[]; };
layout(scalar, binding = kBindProbeOut) writeonly buffer Densities { float densities[]; };
layout(scalar, push_constant) uniform Push { float density, erosion, detail; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= uint(noises.length())) return;
  SmokeLook look;
  look.erosion = erosion;
  look.detail = detail;
  densities[i] = erode(look, density, noises[i], noises[i]);
}
