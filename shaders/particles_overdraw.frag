// A fragment of a particle as one more quad on its pixel, drawn or not.
#version 460

layout(location = 0) out vec4 quads;

void main() { quads = vec4(1.0); }
