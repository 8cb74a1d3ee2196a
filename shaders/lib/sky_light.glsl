// Sky light at a point of the level.
#ifndef SKY_LIGHT_GLSL
#define SKY_LIGHT_GLSL
#include "lib/solid.glsl"
#include "shared/sky_light.h"

layout(binding = kBindSkyLight) uniform sampler3D sky_light;

/// Radiance of the sky around a point: c.x + dot(c.yzw, direction). Interpolates free texels only, so that no light
/// leaks through walls; 0 deep inside solids.
vec4 sky_light_at(vec3 p_world) {
  const vec3 uvw = (p_world - frame.solid.origin_world) / (frame.solid.texel_size * vec3(frame.solid.size));
  return textureLod(sky_light, uvw, 0.0) / max(textureLod(free_texels, uvw, 0.0).r, 1.0 / 64.0);
}

/// Light for a visible fraction of the sky; surfaces reflect a part of the occluded rest.
float with_bounce(float visible) { return mix(frame.sky.bounce, 1.0, clamp(visible, 0.0, 1.0)); }

/// Fraction of the sky's light that reaches a point from all directions, [0, 1]; 1 where nothing occludes it.
float sky_visibility(vec3 p_world) { return with_bounce(sky_light_at(p_world).x / sky_shape(0.0)); }

/// sky_light_at over open ground, which hides the lower half: sky_shape in two bands, of the upper half alone.
const vec4 kSkyOverGround = vec4(0.46875, 0.0, 0.75, 0.0);

/// How far a point lies outside of the level's texels: 0 inside, 1 from a quarter of their width on.
float outside_of_level(vec3 p_world) {
  const vec3 width = frame.solid.texel_size * vec3(frame.solid.size), p = p_world - frame.solid.origin_world;
  return min(4.0 * distance(p, clamp(p, vec3(0.0), width)) / max(width.x, width.z), 1.0);
}

/// Irradiance / pi on a surface under an ambient sky of 1 (Ramamoorthi and Hanrahan 2001: the cosine scales the second
/// band by 2/3).
float sky_irradiance(vec3 p_world, vec3 normal) {
  // One texel off the surface, outside of the texels that it runs through. The outermost texels of a level know nothing
  // of a ground that goes on to the horizon.
  const vec3 off = p_world + frame.solid.texel_size * normal;
  const vec4 light = mix(sky_light_at(off), kSkyOverGround, outside_of_level(off));
  const float direct = max(light.x + 2.0 / 3.0 * dot(light.yzw, normal), 0.0);
  return direct + frame.sky.bounce * (1.0 - clamp(light.x / sky_shape(0.0), 0.0, 1.0));
}

#endif
