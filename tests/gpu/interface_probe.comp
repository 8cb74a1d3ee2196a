// One resource of each kind at sparse bindings, for the tests of reflection.
#version 460
#extension GL_EXT_scalar_block_layout : require

layout(local_size_x = 4, local_size_y = 3, local_size_z = 2) in;
layout(scalar, binding = 9) buffer Values { uint values[]; };
layout(binding = 2) uniform sampler2D sampled_image;
layout(scalar, binding = 0) uniform Constants { vec3 offset; };
layout(binding = 5, rgba8) uniform writeonly image2D stored_image;
layout(scalar, push_constant) uniform Push { vec3 direction; uint count; mat4 matrix; };

void main() {
  const uint i = gl_LocalInvocationIndex;
  if (i < count) values[i] = uint(dot(matrix * vec4(direction + offset, 1.0), vec4(1.0)));
  imageStore(stored_image, ivec2(i, 0), texelFetch(sampled_image, ivec2(i, 0), 0));
}
