// Holes whose cross-section is an image of the mask atlas.
#ifndef HOLE_MASK_GLSL
#define HOLE_MASK_GLSL
#include "shared/hole.h"
#include "shared/hole_clusters.h"

layout(binding = kBindHoleMasks) uniform sampler2D hole_masks;

/// The image at a point of the atlas, [0, 1]. Interpolates in floats, because the filter weights of a texture unit have
/// 8 bits, and lines of sight on a server must match the rendered image.
float mask_at(vec2 uv) {
  const vec2 from_centres = uv * vec2(textureSize(hole_masks, 0)) - 0.5;
  const ivec2 low = ivec2(floor(from_centres)), last = textureSize(hole_masks, 0) - 1;
  const vec2 f = from_centres - vec2(low);
  const ivec2 a = clamp(low, ivec2(0), last), b = clamp(low + 1, ivec2(0), last);
  const float top = mix(texelFetch(hole_masks, a, 0).r, texelFetch(hole_masks, ivec2(b.x, a.y), 0).r, f.x);
  const float bottom = mix(texelFetch(hole_masks, ivec2(a.x, b.y), 0).r, texelFetch(hole_masks, b, 0).r, f.x);
  return mix(top, bottom, f.y);
}

/// hole_strength including the images of masks.
float hole_strength_masked(Hole hole, vec3 p_world, float time, float rim_noise_metres) {
  const HoleCut cut = hole_cut(hole, p_world, time, rim_noise_metres);
  if (hole.shape != kHoleMask || cut.strength <= 0.0) return cut.strength;
  return cut.strength * mask_at(cut.uv);
}

#endif
