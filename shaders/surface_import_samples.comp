// As surface_import.comp, of a multisampled depth: the farthest sample of each pixel, so that smoke hides all that it
// hides of any sample.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_ARB_shader_texture_image_samples : require
#include "lib/surface_import.glsl"

layout(binding = kBindHostDepth) uniform sampler2DMS host_depth;

void main() {
  const ivec2 px = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(uvec2(px), params.size_px))) return;
  const ivec2 from = px + ivec2(params.origin_px);
  float farthest = reverse_depth(texelFetch(host_depth, from, 0).r);
  for (int i = 1; i < textureSamples(host_depth); ++i)
    farthest = min(farthest, reverse_depth(texelFetch(host_depth, from, i).r));
  imageStore(depth_image, px, vec4(farthest));
}
