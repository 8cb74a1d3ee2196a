// Pictures in the top left corner of larger images.
#ifndef IMAGE_PART_GLSL
#define IMAGE_PART_GLSL

/// Where a point of a picture is in its image: between texels of the picture alone.
vec2 uv_of_part(vec2 uv, uvec2 part_px, ivec2 image_px) {
  const vec2 texel = 1.0 / vec2(image_px), scale = vec2(part_px) * texel;
  return min(uv * scale, scale - 0.5 * texel);
}

#endif
