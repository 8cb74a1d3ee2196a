// Transforms a mesh to the clip space of a shadow layer or the sun's map.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/gbuffer.h"

layout(scalar, binding = kBindVertices) readonly buffer Vertices { Vertex vertices[]; };
layout(scalar, push_constant) uniform Push { ShadowDraw draw; };

void main() { gl_Position = draw.clip_from_mesh * vec4(unpacked(vertices[gl_VertexIndex].position), 1.0); }
