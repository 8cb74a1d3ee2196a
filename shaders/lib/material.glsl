// The material of a fragment, by its maps.
#ifndef MATERIAL_GLSL
#define MATERIAL_GLSL
#include "lib/frame.glsl"
#include "shared/gbuffer.h"

layout(binding = kBindBaseColorMap) uniform sampler2D base_color_map;
layout(binding = kBindNormalMap) uniform sampler2D normal_map;
layout(binding = kBindRoughnessMap) uniform sampler2D roughness_map;
layout(scalar, push_constant) uniform Push { DrawConstants draw; };

layout(location = 0) in vec3 normal_world;
layout(location = 1) in vec4 tangent_world;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec4 color_complement;

/// The colour, and the alpha of image and vertex.
vec4 base_color_here() {
  const vec4 base = texture(base_color_map, uv, frame.texture_bias) * (1.0 - color_complement);
  return vec4(base.rgb * draw.material.base_color, base.a);
}

/// Unit, towards the side that is seen.
vec3 normal_here() {
  vec3 n = normalize(normal_world);
  const vec3 t = tangent_world.xyz - n * dot(n, tangent_world.xyz);
  if (dot(t, t) > 1e-12) {
    const vec3 mapped = texture(normal_map, uv, frame.texture_bias).xyz * 2.0 - 1.0;
    const vec3 tangent = normalize(t);
    n = normalize(mapped.x * tangent + mapped.y * tangent_world.w * cross(n, tangent) + mapped.z * n);
  }
  return gl_FrontFacing ? n : -n;
}

/// Roughness and metallic.
vec2 roughness_metallic_here() {
  const vec4 maps = texture(roughness_map, uv, frame.texture_bias);
  return vec2(draw.material.roughness * maps.g, draw.material.metallic * maps.b);
}

#endif
