// A wall that fills the picture, and triangles in front of it whose edges cross pixels, as reverse depth.
#version 460

void main() {
  const vec2 kCorners[9] = vec2[](vec2(-1.0, -1.0), vec2(3.0, -1.0), vec2(-1.0, 3.0),
                                  vec2(-0.7, -0.9), vec2(0.3, -0.2), vec2(-0.8, 0.8),
                                  vec2(0.1, 0.9), vec2(0.8, 0.7), vec2(0.45, -0.95));
  const float kDistances[3] = float[](9.0, 2.0, 5.0);  // [m]
  gl_Position = vec4(kCorners[gl_VertexIndex], 0.1 / kDistances[gl_VertexIndex / 3], 1.0);
}
