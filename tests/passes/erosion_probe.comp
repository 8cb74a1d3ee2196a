// What erode leaves of a density at given noises.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/erosion.glsl"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Noises { vec4 noises[]; };
layout(scalar, binding = 1) writeonly buffer Densities { float densities[]; };
layout(push_constant, scalar) uniform Impulse { float density, erosion; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= uint(noises.length())) return;
  SmokeLook look;
  look.erosion = erosion;
  densities[i] = erode(look, density, noises[i]);
}
