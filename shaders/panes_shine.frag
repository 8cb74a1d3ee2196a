// What a pane adds to the picture that panes_filter.frag has filtered: what it reflects and emits, through the media
// and tanks before it, and what these themselves lost to the filter.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/pane.glsl"
#include "lib/shading.glsl"
#include "shared/layers.h"
#include "shared/resolve.h"
#include "shared/smoke_shadow.h"

layout(constant_id = 0) const uint kMedia = 0u;         // those that may be before a pane
layout(constant_id = 1) const uint kVoxelShadows = 1u;  // 0: no light is shadowed by voxels
layout(constant_id = 2) const uint kTanks = 0u;         // 1: tanks are among the layers

layout(binding = kBindSmoke) uniform sampler2D smoke;
layout(binding = kBindLayers) uniform sampler2D layers;
layout(binding = kBindLayerDepth) uniform sampler2D layer_depth;
layout(binding = kBindSmokeShadows) uniform sampler2D smoke_shadows;
#include "lib/light_rows.glsl"
#include "lib/smoke_transmittance.glsl"
#include "lib/indirect_light.glsl"
#include "lib/sky_light.glsl"
#include "lib/surface_lights.glsl"
#include "lib/media_light.glsl"

layout(location = 0) out vec4 shine;

const uint kVolumeSteps = 32u;
/// How far the short march may be off, as a fraction of the optical depth: so much from none, or from all, is that.
const float kRough = 0.05;

/// The media between the eye and the pane: premultiplied radiance and transmittance. Of the picture's media, whose
/// light is taken to be alike before and behind: exact where they are on one side alone, as where glass stops them.
vec4 media_before(Pane pane) {
  const vec4 all = texelFetch(smoke, ivec2(gl_FragCoord.xy), 0);
  if (all.a > 0.999) return vec4(0.0, 0.0, 0.0, 1.0);
  const float depth = media_depth(media_point(frame.camera.eye_world), -pane.view, pane.distance,
                                  depth_steps(1.0, kVolumeSteps));
  const float whole = -log(max(all.a, 1e-4));
  const float before = clamp((depth / whole - kRough) / (1.0 - 2.0 * kRough), 0.0, 1.0);
  const float transmittance = exp(-whole * before);
  return vec4(all.rgb * ((1.0 - transmittance) / (1.0 - all.a)), transmittance);
}

/// Media and tanks between the eye and the pane. Glass of a tank, which has no depth, is behind it.
vec4 layers_before(Pane pane) {
  const ivec2 px = ivec2(gl_FragCoord.xy);
  const bool behind = kTanks != 0u && texelFetch(layer_depth, px, 0).r > gl_FragCoord.z;
  return behind ? texelFetch(layers, px, 0) : media_before(pane);
}

/// Reflected radiance of all lights.
vec3 lights_radiance(Pane pane, Surface surface) {
  const vec2 texel_uv = 1.0 / vec2(textureSize(smoke_shadows, 0));
  vec3 radiance = vec3(0.0);
  for (uint i = 0u; i < frame.light_count; ++i) {
    const Light light = light_from_rows(i);
    const LightOnSurface on = light_on_surface(light, surface.position_world, surface.normal);
    // The reflection alone needs glass.
    const vec3 lambert = surface.albedo / kPi;
    const vec3 reflected = on.received * light.intensity *
                           mix(lambert, reflectance(surface, pane.view, on.to_light), pane.weight);
    if (max(reflected.r, max(reflected.g, reflected.b)) <= 1e-5) continue;
    radiance += reflected * visibility_on_surface(light, on) * smoke_transmittance(i, on.on_face, texel_uv);
  }
  return radiance;
}

/// Radiance that arrives from around a direction.
vec3 arriving(vec3 p_world, vec3 direction) {
  return frame.indirect.bounces > 0u ? indirect_irradiance(p_world, direction)
                                     : frame.sky.ambient * sky_irradiance(p_world, direction);
}

void main() {
  const Pane pane = pane_here();
  const Surface surface =
      Surface(pane.position_world, pane.normal, pane.albedo, roughness_metallic_here().x, 0.0);
  vec3 radiance = draw.material.emission + lights_radiance(pane, surface);
  radiance += pane_reflectance(pane.weight, dot(pane.normal, pane.view)) *
              arriving(pane.position_world, reflect(-pane.view, pane.normal));
  if (pane.albedo != vec3(0.0)) radiance += pane.albedo * arriving(pane.position_world, pane.normal);
  const vec4 before = layers_before(pane);
  shine = vec4(before.rgb * (1.0 - pane.passes) + before.a * radiance, 0.0);
}
