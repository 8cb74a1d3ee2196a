// Transforms a mesh to clip space.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/frame.glsl"
#include "shared/gbuffer.h"

layout(scalar, binding = kBindVertices) readonly buffer Vertices { Vertex vertices[]; };
layout(scalar, push_constant) uniform Push { DrawConstants draw; };

// Equal in the pipelines with and without a fragment shader.
invariant gl_Position;
layout(location = 0) out vec3 normal_world;
layout(location = 1) out vec4 tangent_world;
layout(location = 2) out vec2 uv;
layout(location = 3) out vec4 color_complement;

void main() {
  const Vertex vertex = vertices[gl_VertexIndex];
  const Affine rows = draw.world_from_mesh;
  const mat3 linear = transpose(mat3(rows.row0.xyz, rows.row1.xyz, rows.row2.xyz));
  const vec3 position_world = linear * unpacked(vertex.position) + vec3(rows.row0.w, rows.row1.w, rows.row2.w);
  // The cofactor matrix transforms normals correctly under any scale, mirroring included.
  const mat3 cofactor = mat3(cross(linear[1], linear[2]), cross(linear[2], linear[0]), cross(linear[0], linear[1]));
  const float handedness = determinant(linear) < 0.0 ? -1.0 : 1.0;
  normal_world = handedness * (cofactor * unpacked(vertex.normal));
  const vec4 tangent = unpacked(vertex.tangent);
  tangent_world = vec4(linear * tangent.xyz, tangent.w * handedness);
  uv = vertex.uv;
  color_complement =
      vec4(unpackUnorm2x16(vertex.color_complement.x), unpackUnorm2x16(vertex.color_complement.y));
  gl_Position = frame.camera.clip_from_world * vec4(position_world, 1.0);
}
