// Writes the material and the normal of the nearest surface.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
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

layout(location = 0) out vec4 albedo_roughness;
layout(location = 1) out vec4 normal_metallic;
layout(location = 2) out vec4 emission;

void main() {
  const vec4 base = texture(base_color_map, uv, frame.texture_bias) * (1.0 - color_complement);
  if (base.a < draw.material.alpha_cutoff) discard;
  vec3 n = normalize(normal_world);
  const vec3 t = tangent_world.xyz - n * dot(n, tangent_world.xyz);
  if (dot(t, t) > 1e-12) {
    const vec3 mapped = texture(normal_map, uv, frame.texture_bias).xyz * 2.0 - 1.0;
    const vec3 tangent = normalize(t);
    n = normalize(mapped.x * tangent + mapped.y * tangent_world.w * cross(n, tangent) + mapped.z * n);
  }
  if (!gl_FrontFacing) n = -n;
  const vec4 maps = texture(roughness_map, uv, frame.texture_bias);
  albedo_roughness = vec4(base.rgb * draw.material.base_color, draw.material.roughness * maps.g);
  normal_metallic = vec4(n, metallic_and_moves(draw.material.metallic * maps.b, draw.moves));
  emission = vec4(draw.material.emission, 0.0);
}
