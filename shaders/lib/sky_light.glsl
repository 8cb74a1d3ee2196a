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

/// sky_light_at where nothing hides the sky: sky_shape.
const vec4 kOpenSky = vec4(0.75, 0.0, 0.375, 0.0);

/// How far a point lies outside of the level's texels: 0 inside, 1 from a quarter of their width on.
float outside_of_level(vec3 p_world) {
  const vec3 width = frame.solid.texel_size * vec3(frame.solid.size), p = p_world - frame.solid.origin_world;
  return min(4.0 * distance(p, clamp(p, vec3(0.0), width)) / max(width.x, width.z), 1.0);
}

/// The sky around a point of a medium, as sky_light_at; open beyond the level.
vec4 sky_around(vec3 p_world) { return mix(sky_light_at(p_world), kOpenSky, outside_of_level(p_world)); }

/// From a direction: x the radiance of the sky, under an ambient sky of 1; y the fraction of it that surfaces hide.
vec2 seen_around(vec4 sky, vec3 direction) {
  const float seen = max(sky.x + dot(sky.yzw, direction), 0.0);
  return vec2(seen, max(1.0 - seen / sky_shape(direction.y), 0.0));
}

/// Radiance of the sky and of the surfaces that hide it, for (sums of) seen_around. `on_ground`: irradiance of the sun
/// on a level surface; surfaces reflect as much of it as of the ambient light.
vec3 radiance_around(vec2 seen, vec3 on_ground) {
  return frame.sky.ambient * seen.x + seen.y * frame.sky.bounce * (frame.sky.ambient + on_ground / 3.14159265);
}

/// Irradiance / pi on a surface under an ambient sky of 1 (Ramamoorthi and Hanrahan 2001: the cosine scales the second
/// band by 2/3).
float sky_irradiance(vec3 p_world, vec3 normal) {
  // One texel off the surface, outside of the texels that it runs through. The outermost texels of a level know nothing
  // of a ground that goes on to the horizon.
  const vec3 off = p_world + frame.solid.texel_size * normal;
  const vec4 light = mix(sky_light_at(off), kOpenSky, outside_of_level(off));
  const float direct = max(light.x + 2.0 / 3.0 * dot(light.yzw, normal), 0.0);
  return direct + frame.sky.bounce * (1.0 - clamp(light.x / sky_shape(0.0), 0.0, 1.0));
}

#endif
