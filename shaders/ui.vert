// Panels, text and lines of the viewer.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/ui.h"

layout(scalar, binding = kBindUiVertices) readonly buffer Vertices { UiVertex vertices[]; };
layout(scalar, push_constant) uniform Push { UiConstants ui; };

layout(location = 0) out vec4 colour;
layout(location = 1) out vec2 uv;

void main() {
  const UiVertex vertex = vertices[gl_VertexIndex];
  colour = unpackUnorm4x8(vertex.colour);
  uv = unpacked(vertex.uv);
  gl_Position = vec4(2.0 * (unpacked(vertex.position) - ui.origin) / ui.size - 1.0, 0.0, 1.0);
}
