// The colour of a vertex, where the font covers the pixel.
#version 460

layout(binding = 1) uniform sampler2D font;

layout(location = 0) in vec4 colour;
layout(location = 1) in vec2 uv;
layout(location = 0) out vec4 shown;

void main() { shown = vec4(colour.rgb, colour.a * texture(font, uv).r); }
