// Vertex colour times the coverage of the font atlas.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/ui.h"

layout(binding = kBindUiFont) uniform sampler2D font;

layout(location = 0) in vec4 colour;
layout(location = 1) in vec2 uv;
layout(location = 0) out vec4 shown;

void main() { shown = vec4(colour.rgb, colour.a * texture(font, uv).r); }
