// Lights the G-buffer: every lamp within reach, with its shadow, and the sky where nothing stands.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/camera.glsl"
#include "lib/lights.glsl"
#include "lib/shading.glsl"
#include "lib/sky.glsl"
#include "shared/frame.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, binding = 0) readonly buffer Frame { FrameConstants frame; };
layout(scalar, binding = 1) readonly buffer Lights { Light lights[]; };
layout(scalar, binding = 2) readonly buffer Views { ShadowView sun; };
layout(binding = 3) uniform sampler2DArrayShadow shadows;
layout(binding = 4) uniform sampler2D albedo_roughness;
layout(binding = 5) uniform sampler2D normal_metallic;
layout(binding = 6) uniform sampler2D emission;
layout(binding = 7) uniform sampler2D depth;
layout(binding = 8) uniform sampler2DArray smoke_shadows;
layout(binding = 9, rgba16f) uniform writeonly image2D lit;

/// Whether a lamp is near enough and in front of the surface.
bool can_reach(Light light, Surface surface) {
  if (light.kind == kLightDirectional) return dot(light.direction, surface.normal) < 0.0;
  const vec3 apart = light.position_world - surface.position_world;
  return dot(apart, apart) < light.range * light.range && dot(apart, surface.normal) > 0.0;
}

/// What the surface reflects of a lamp's light, after the scene's shadow and the smoke in between.
vec3 lamp_radiance(Light light, Surface surface, vec3 view) {
  const Incident incident = light_at(light, surface.position_world);
  // A surface must not shadow itself: it is looked up a shadow texel off its plane.
  const float off = 0.01 + 0.006 * min(incident.distance, 10.0);
  const vec4 shadow = shadow_coordinates(light, sun.clip_from_world, surface.position_world + off * surface.normal);
  const float smoke = shadow.z < 0.0 ? 1.0 : exp(-textureLod(smoke_shadows, shadow.xyz, 0.0).r);
  return reflect_light(surface, view, incident.to_light) * incident.irradiance * (shadow_at(shadows, shadow) * smoke);
}

void main() {
  const ivec2 px = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(uvec2(px), frame.size_px))) return;
  const vec3 ray = camera_ray(frame.camera, vec2(px) + 0.5, frame.size_px);
  const float d = texelFetch(depth, px, 0).r;
  if (d <= 0.0) {
    imageStore(lit, px, vec4(sky_radiance(frame.sky, normalize(ray)), 1.0));
    return;
  }

  const vec4 a = texelFetch(albedo_roughness, px, 0), n = texelFetch(normal_metallic, px, 0);
  const float along = view_distance(frame.camera, d);
  const Surface surface = Surface(frame.camera.eye_world + along * ray, normalize(n.xyz), a.rgb, a.a, n.a);
  const vec3 view = -normalize(ray);

  // The sky's light, a little more of it on what faces up.
  vec3 radiance = texelFetch(emission, px, 0).rgb;
  radiance += surface.albedo * frame.sky.ambient * (0.75 + 0.25 * surface.normal.y);

  // Lamps in runs of 32: first the cheap question for each, then the work for those that are left.
  for (uint first = 0u; first < frame.light_count; first += 32u) {
    uint left = 0u;
    for (uint i = first; i < min(first + 32u, frame.light_count); ++i) {
      if (can_reach(lights[i], surface)) left |= 1u << (i - first);
    }
    for (; left != 0u; left &= left - 1u) radiance += lamp_radiance(lights[first + uint(findLSB(left))], surface, view);
  }
  imageStore(lit, px, vec4(radiance, 1.0));
}
