// The media over a host picture: premultiplied radiance, and in alpha what blending multiplies the picture by: the
// transmittance, and what decals leave of the light of the surfaces.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/surface_import.h"

layout(binding = kBindMediaLayer) uniform sampler2D media;
layout(binding = kBindLayerOcclusion) uniform sampler2D occlusion;
layout(scalar, push_constant) uniform Push { MediaLayerParams params; };
layout(location = 0) out vec4 colour;

void main() {
  const ivec2 px = ivec2(gl_FragCoord.xy) - ivec2(params.origin_px);
  const vec4 here = texelFetch(media, px, 0);
  const float remaining = params.has_decals != 0u ? 1.0 - texelFetch(occlusion, px, 0).r : 1.0;
  colour = vec4(here.rgb * params.exposure, here.a * remaining);
}
