// The media over a host picture: premultiplied radiance, and in alpha the transmittance, which blending multiplies the
// picture by.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/surface_import.h"

layout(binding = kBindMediaLayer) uniform sampler2D media;
layout(scalar, push_constant) uniform Push { MediaLayerParams params; };
layout(location = 0) out vec4 colour;

void main() {
  const vec4 here = texelFetch(media, ivec2(gl_FragCoord.xy), 0);
  colour = vec4(here.rgb * params.exposure, here.a);
}
