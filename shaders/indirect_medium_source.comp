// Radiance that the media in each cell scatter in every direction, per metre.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/indirect_light.glsl"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(binding = kBindMediumDirect) uniform sampler3D medium_direct;
layout(binding = kBindMediumMatter) uniform sampler3D medium_matter;
layout(binding = kBindIndirectTarget, rgba16f) uniform writeonly image3D target;
layout(scalar, push_constant) uniform Push { IndirectParams params; };

void main() {
  const ivec3 cell = params.media_low + ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(cell, params.media_high))) return;
  const vec4 direct = texelFetch(medium_direct, cell, 0), matter = texelFetch(medium_matter, cell, 0);
  vec3 source = vec3(0.0);
  if (direct.a > 0.0) {
    vec4 sum = vec4(0.0);
    for (int slab = 0; slab < int(kLightSlabs); ++slab)
      sum += texelFetch(indirect_cube, cell + ivec3(0, 0, slab * frame.indirect.size.z), 0);
    source = matter.rgb * (direct.rgb + sum.rgb / float(kLightSlabs));
  }
  imageStore(target, cell, vec4(source, matter.a));
}
