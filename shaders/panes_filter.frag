// What a pane lets through of all that is behind it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/pane.glsl"

layout(location = 0) out vec4 filtered;

void main() {
  const vec3 passes = pane_here().passes;
  filtered = vec4(passes, dot(passes, vec3(1.0 / 3.0)));
}
