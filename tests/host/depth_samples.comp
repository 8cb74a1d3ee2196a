// The samples of a multisampled depth, pixel by pixel.
#version 460

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2DMS depth;
layout(std430, binding = 1) writeonly buffer Samples { float samples[]; };

void main() {
  const ivec2 px = ivec2(gl_GlobalInvocationID.xy), size = textureSize(depth);
  if (any(greaterThanEqual(px, size))) return;
  for (int i = 0; i < 4; ++i) samples[4 * (px.x + size.x * px.y) + i] = texelFetch(depth, px, i).r;
}
