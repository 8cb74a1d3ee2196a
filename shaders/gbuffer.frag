// Writes the material and the normal of the nearest surface.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/material.glsl"

layout(location = 0) out vec4 albedo_roughness;
layout(location = 1) out vec4 normal_metallic;
layout(location = 2) out vec4 emission;

void main() {
  const vec4 base = base_color_here();
  if (base.a < draw.material.alpha_cutoff) discard;
  const vec2 roughness_metallic = roughness_metallic_here();
  albedo_roughness = vec4(base.rgb, roughness_metallic.x);
  normal_metallic = vec4(normal_here(), metallic_and_moves(roughness_metallic.y, draw.moves));
  emission = vec4(draw.material.emission, 0.0);
}
