// An array of samplers, which no pipeline offers.
#version 460

layout(local_size_x = 1) in;
layout(binding = 0) uniform sampler2D images[4];
layout(binding = 1, rgba8) uniform writeonly image2D stored_image;

void main() {
  const vec4 first = texelFetch(images[0], ivec2(0), 0), last = texelFetch(images[3], ivec2(0), 0);
  imageStore(stored_image, ivec2(0), first + last);
}
