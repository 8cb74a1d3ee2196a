// Density after erosion at given noises, as rays from the eye and as light meets it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/erosion.glsl"

#include "probes.h"

struct Noise {
  PackedVec4 tile;
  vec2 detail;
};

layout(local_size_x = 64) in;
layout(scalar, binding = kBindProbeIn) readonly buffer Noises { Noise noises[]; };
layout(scalar, binding = kBindProbeOut) writeonly buffer Densities { float densities[]; };
layout(scalar, push_constant) uniform Push { float density, erosion, detail; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= uint(noises.length())) return;
  SmokeLook look;
  look.erosion = erosion;
  look.detail = detail;
  densities[i] = erode(look, density, unpacked(noises[i].tile), noises[i].detail, detail);
}
