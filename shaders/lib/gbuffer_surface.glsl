// What every surface leaves in the G-buffer.
#ifndef GBUFFER_SURFACE_GLSL
#define GBUFFER_SURFACE_GLSL
#include "lib/material.glsl"

layout(location = 0) out vec4 albedo_roughness;
layout(location = 1) out vec4 normal_metallic;

void write_surface() {
  const vec4 base = base_color_here();
  if (base.a < draw.material.alpha_cutoff) discard;
  const vec2 roughness_metallic = roughness_metallic_here();
  albedo_roughness = vec4(base.rgb, roughness_metallic.x);
  normal_metallic = vec4(normal_here(), metallic_and_moves(roughness_metallic.y, draw.moves));
}

#endif
