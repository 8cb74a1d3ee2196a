// Writes the material and the normal of the nearest surface.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/gbuffer_surface.glsl"

layout(location = 2) out vec4 emission;

void main() {
  write_surface();
  emission = vec4(draw.material.emission, 0.0);
}
