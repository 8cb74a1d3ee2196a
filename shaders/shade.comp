// Lights the G-buffer and puts the smoke over it: every lamp within reach, with its shadow, the sky where nothing
// stands. What the smoke hides is not lit at all.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define BINDING_SKY_LIGHT 10
#define BINDING_SOLID 11
#include "lib/camera.glsl"
#include "lib/lights.glsl"
#include "lib/shading.glsl"
#include "lib/sky.glsl"
#include "shared/frame.h"
#include "shared/smoke_shadow.h"

layout(constant_id = 0) const uint kCullLights = 1u;  // 0: every light at every pixel

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, binding = 0) readonly buffer Frame { FrameConstants frame; };
layout(scalar, binding = 1) readonly buffer Lights { Light lights[]; };
layout(scalar, binding = 2) readonly buffer Views { ShadowView sun; };
layout(binding = 3) uniform sampler2DArrayShadow shadows;
layout(binding = 4) uniform sampler2D albedo_roughness;
layout(binding = 5) uniform sampler2D normal_metallic;
layout(binding = 6) uniform sampler2D emission;
layout(binding = 7) uniform sampler2D depth;
layout(binding = 8) uniform sampler2D smoke_shadows;
layout(binding = 9) uniform sampler2D smoke;
layout(scalar, binding = 12) readonly buffer Faces { SmokeShadowFace faces[]; };
layout(binding = 13, rgba16f) uniform writeonly image2D picture;
#include "lib/light_share.glsl"
#include "lib/sky_light.glsl"

// A tile is a workgroup. Its lights are bits, so that each pixel adds them up in their order, whoever found them.
const uint kTile = 8u, kBatch = 512u;
shared uint nearest_along, farthest_along;  // bits of distances along the view axis, which order as integers
shared uint tile_lights[kBatch / 32u];

/// A box in the world around the part of the view that the tile sees between two distances.
TileBox tile_box(float nearest, float farthest) {
  const vec2 corner_px = vec2(gl_WorkGroupID.xy * kTile);
  TileBox box = TileBox(vec3(1e30), vec3(-1e30));
  for (uint i = 0u; i < 4u; ++i) {
    const vec3 ray = camera_ray(frame.camera, corner_px + float(kTile) * vec2(i & 1u, i >> 1u), frame.size_px);
    box.low = min(box.low, min(nearest * ray, farthest * ray));
    box.high = max(box.high, max(nearest * ray, farthest * ray));
  }
  // Wider than what rounding may move a pixel's surface.
  const float slack = 1e-5 * (farthest + length(frame.camera.eye_world));
  return TileBox(frame.camera.eye_world + box.low - slack, frame.camera.eye_world + box.high + slack);
}

/// The lights of a batch that reach the tile, found by all its threads together.
void gather_lights(uint first, TileBox box) {
  const uint thread = gl_LocalInvocationIndex;
  barrier();  // the batch before is done with
  if (thread < kBatch / 32u) tile_lights[thread] = 0u;
  barrier();
  for (uint i = first + thread; i < min(first + kBatch, frame.light_count); i += kTile * kTile) {
    if (kCullLights == 0u || reaches_box(lights[i], box)) atomicOr(tile_lights[(i - first) >> 5u], 1u << (i & 31u));
  }
  barrier();
}

/// Whether a lamp is near enough and in front of the surface.
bool can_reach(Light light, Surface surface) {
  if (light.kind == kLightDirectional) return dot(light.direction, surface.normal) < 0.0;
  const vec3 apart = light.position_world - surface.position_world;
  return dot(apart, apart) < light.range * light.range && dot(apart, surface.normal) > 0.0;
}

/// Share of a light that the smoke lets through to a surface.
float smoke_share(uint index, Light light, vec3 position_world) {
  vec4 on_face = vec4(0.0);
  if (light.kind == kLightDirectional) on_face.xy = (sun.clip_from_world * vec4(position_world, 1.0)).xy * 0.5 + 0.5;
  else on_face = cube_coordinates(position_world - light.position_world);
  const SmokeShadowFace face = faces[index * kFacesPerLight + uint(on_face.z)];
  const vec2 texel = on_face.xy * face.scale + face.offset;
  const vec2 inside = clamp(texel, vec2(face.first_texel) + 0.5, vec2(face.first_texel + face.size) - 0.5);
  if (face.size.x == 0u || texel != inside) return 1.0;
  return textureLod(smoke_shadows, texel / vec2(textureSize(smoke_shadows, 0)), 0.0).r;
}

/// What the surface reflects of a lamp's light, after the scene's shadow and the smoke in between.
vec3 lamp_radiance(uint index, Surface surface, vec3 view) {
  const Light light = lights[index];
  const Incident incident = light_at(light, surface.position_world);
  // A surface must not shadow itself: it is looked up a texel of the shadow off its plane.
  const float off = light.shadow_layer == kShadowByVoxels ? frame.solid.texel_size : 0.01 + 0.006 * min(incident.distance, 10.0);
  const vec3 off_world = surface.position_world + off * surface.normal;
  const float share = light_share(light, off_world);
  vec3 radiance = vec3(0.0);
  // A loop that runs at most once: a software rasteriser skips those, not branches, and most lamps are behind walls.
  for (bool lit = share > 0.0; lit; lit = false) {
    radiance = reflect_light(surface, view, incident.to_light) * incident.irradiance *
               (share * smoke_share(index, light, off_world));
  }
  return radiance;
}

/// The light of the gathered lamps of a batch.
vec3 lamps_radiance(uint first, Surface surface, vec3 view) {
  vec3 radiance = vec3(0.0);
  for (uint word = 0u; word < min((frame.light_count - first + 31u) / 32u, kBatch / 32u); ++word) {
    // First the cheap question for each, then the work for those that are left.
    uint left = 0u;
    for (uint bits = tile_lights[word]; bits != 0u; bits &= bits - 1u) {
      const uint bit = uint(findLSB(bits));
      if (can_reach(lights[first + 32u * word + bit], surface)) left |= 1u << bit;
    }
    for (; left != 0u; left &= left - 1u)
      radiance += lamp_radiance(first + 32u * word + uint(findLSB(left)), surface, view);
  }
  return radiance;
}

void main() {
  const ivec2 px = ivec2(gl_GlobalInvocationID.xy);
  const bool inside = all(lessThan(uvec2(px), frame.size_px));
  if (gl_LocalInvocationIndex == 0u) {
    nearest_along = 0xffffffffu;
    farthest_along = 0u;
  }
  barrier();

  const vec3 ray = camera_ray(frame.camera, vec2(px) + 0.5, frame.size_px);
  const vec4 over = inside ? texelFetch(smoke, px, 0) : vec4(0.0);
  const float d = inside ? texelFetch(depth, px, 0).r : 0.0;
  const float along = view_distance(frame.camera, d);
  const bool seen = over.a > 0.0, lit = seen && d > 0.0;
  if (lit) {
    atomicMin(nearest_along, floatBitsToUint(along));
    atomicMax(farthest_along, floatBitsToUint(along));
  }
  barrier();

  const vec4 a = texelFetch(albedo_roughness, px, 0), n = texelFetch(normal_metallic, px, 0);
  const Surface surface = Surface(frame.camera.eye_world + along * ray, normalize(n.xyz), a.rgb, a.a, n.a);
  const vec3 view = -normalize(ray);
  vec3 radiance = vec3(0.0);
  if (lit) {
    radiance = texelFetch(emission, px, 0).rgb +
               surface.albedo * frame.sky.ambient * sky_irradiance(surface.position_world, surface.normal);
  } else if (seen) {
    radiance = sky_radiance(frame.sky, normalize(ray));
  }

  // Nothing to light: no round, not even of a batch.
  const uint light_count = farthest_along == 0u ? 0u : frame.light_count;
  const TileBox box = tile_box(uintBitsToFloat(nearest_along), uintBitsToFloat(farthest_along));
  for (uint first = 0u; first < light_count; first += kBatch) {
    gather_lights(first, box);
    if (lit) radiance += lamps_radiance(first, surface, view);
  }
  if (inside) imageStore(picture, px, vec4(over.rgb + over.a * radiance, 1.0));
}
