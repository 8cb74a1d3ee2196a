// Transforms a mesh to the clip space of a shadow layer or the sun's map, for materials that a texture cuts out.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/gbuffer.h"

layout(scalar, binding = kBindVertices) readonly buffer Vertices { Vertex vertices[]; };
layout(scalar, push_constant) uniform Push { ShadowDraw draw; };

layout(location = 0) out vec2 uv;
layout(location = 1) out float alpha_complement;

void main() {
  const Vertex vertex = vertices[gl_VertexIndex];
  uv = vertex.uv;
  alpha_complement = unpackUnorm2x16(vertex.color_complement.y).y;
  gl_Position = draw.clip_from_mesh * vec4(unpacked(vertex.position), 1.0);
}
