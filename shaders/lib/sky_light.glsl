// Light of the sky at a point of the level. Needs `frame`; the includer defines BINDING_SKY_LIGHT and BINDING_SOLID.
#ifndef SKY_LIGHT_GLSL
#define SKY_LIGHT_GLSL
#include "lib/solid.glsl"
#include "shared/frame.h"
#include "shared/sky_light.h"

layout(binding = BINDING_SKY_LIGHT) uniform sampler3D sky_light;

/// Radiance of the sky around a point: c.x + dot(c.yzw, direction). From the free texels around it alone, so that
/// nothing comes through walls; 0 deep in solid.
vec4 sky_light_at(vec3 p_world) {
  const vec3 uvw = (p_world - frame.solid.origin_world) / (frame.solid.texel_size * vec3(frame.solid.size));
  return textureLod(sky_light, uvw, 0.0) / max(textureLod(free_texels, uvw, 0.0).r, 1.0 / 64.0);
}

/// Share of the sky that is seen around a point, [0, 1], and for what is hidden what surfaces throw back of it.
float with_bounce(float seen) { return mix(frame.sky.bounce, 1.0, clamp(seen, 0.0, 1.0)); }

/// Share of the sky's light that comes to a point from all around, [0, 1]; 1 where nothing is in the way.
float sky_visibility(vec3 p_world) { return with_bounce(sky_light_at(p_world).x / sky_shape(0.0)); }

/// Irradiance / pi by the sky's ambient light of 1 on a surface (Ramamoorthi and Hanrahan 2001: the cosine takes the
/// second band to 2/3).
float sky_irradiance(vec3 p_world, vec3 normal) {
  // A texel off the surface: out of those that it runs through.
  const vec4 light = sky_light_at(p_world + frame.solid.texel_size * normal);
  const float direct = max(light.x + 2.0 / 3.0 * dot(light.yzw, normal), 0.0);
  return direct + frame.sky.bounce * (1.0 - clamp(light.x / sky_shape(0.0), 0.0, 1.0));
}

#endif
