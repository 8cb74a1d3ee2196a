// Boxes: their corners follow from the number of the vertex.
#version 460

struct Box {
  vec4 low, high, colour;
};
layout(push_constant) uniform Push {
  mat4 clip_from_world;
  Box box;
} push;
layout(location = 0) out vec3 normal;
layout(location = 1) out vec3 colour;
layout(location = 2) out vec3 p_world;

void main() {
  const int face = gl_VertexIndex / 6, corner = int[](0, 1, 2, 2, 1, 3)[gl_VertexIndex % 6];
  const int axis = face >> 1;
  vec3 at;
  at[axis] = float(face & 1);
  at[(axis + 1) % 3] = float(corner & 1);
  at[(axis + 2) % 3] = float(corner >> 1);
  normal = vec3(0.0);
  normal[axis] = 2.0 * float(face & 1) - 1.0;
  colour = push.box.colour.rgb;
  p_world = mix(push.box.low.xyz, push.box.high.xyz, at);
  gl_Position = push.clip_from_world * vec4(p_world, 1.0);
}
