// Leaves out of a shadow layer or the sun's map what a texture cuts out of a surface, as gbuffer.frag does.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/gbuffer.h"

layout(binding = kBindBaseColorMap) uniform sampler2D base_color_map;
layout(scalar, push_constant) uniform Push { ShadowDraw draw; };

layout(location = 0) in vec2 uv;
layout(location = 1) in float alpha_complement;

void main() {
  if (texture(base_color_map, uv).a * (1.0 - alpha_complement) < draw.alpha_cutoff) discard;
}
