// Shades the G-buffer under the smoke: all lights within reach with their shadows, and the sky behind the scene. Skips
// pixels behind opaque smoke. Displays the pixel, too, where nothing else changes its radiance.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_vote : require
#include "lib/frame.glsl"
#include "lib/camera.glsl"
#include "lib/displayed.glsl"
#include "lib/lights.glsl"
#include "lib/shading.glsl"
#include "lib/sky.glsl"
#include "shared/decal.h"
#include "shared/display.h"
#include "shared/gbuffer.h"
#include "shared/resolve.h"
#include "shared/smoke_shadow.h"

layout(constant_id = 0) const uint kCullLights = 1u;  // 0: every light at every pixel
layout(constant_id = 1) const uint kVoxelShadows = 1u;  // 0: no light is shadowed by voxels
layout(constant_id = 2) const uint kDecals = 0u;        // 0: nothing reads the occlusion by decals

layout(constant_id = 3) const uint kDisplays = 1u;      // 0: writes radiance alone

const uint kGroup = 8u;
layout(local_size_x = kGroup, local_size_y = kGroup) in;
layout(binding = kBindAlbedoRoughness) uniform sampler2D albedo_roughness;
layout(binding = kBindNormalMetallic) uniform sampler2D normal_metallic;
layout(binding = kBindEmission) uniform sampler2D emission;
layout(binding = kBindDepth) uniform sampler2D depth;
layout(binding = kBindSmokeShadows) uniform sampler2D smoke_shadows;
layout(binding = kBindSmoke) uniform sampler2D smoke;
layout(binding = kBindOcclusion) uniform sampler2D decal_occlusion;
layout(binding = kBindRadiance, rgba16f) uniform writeonly image2D radiance_image;
layout(binding = kBindDisplay, rgba8) uniform writeonly image2D display;
#include "lib/light_rows.glsl"
#include "lib/smoke_transmittance.glsl"
#include "lib/indirect_light.glsl"
#include "lib/sky_light.glsl"
#include "lib/surface_lights.glsl"

/// Bounds of the surfaces of a tile. A tile is a subgroup: each thread tests one light, without barriers.
struct TileSurfaces {
  vec3 low_world, high_world;    // bounds of the positions
  vec3 low_normal, high_normal;  // and of the normals
};

TileSurfaces surfaces_of_tile(bool lit, vec3 position_world, vec3 normal) {
  const vec3 nothing = vec3(1e30);
  return TileSurfaces(subgroupMin(lit ? position_world : nothing), subgroupMax(lit ? position_world : -nothing),
                      subgroupMin(lit ? normal : nothing), subgroupMax(lit ? normal : -nothing));
}

/// False only where the light is behind every surface of the tile.
bool faces_tile(Light light, TileSurfaces tile) {
  const bool directional = light.kind == kLightDirectional;
  // Upper bound of the dot product of two vectors, each inside a box: direction to the light, and normal.
  const vec3 low = directional ? -light.direction : light.position_world - tile.high_world;
  const vec3 high = directional ? -light.direction : light.position_world - tile.low_world;
  const vec3 most = max(max(low * tile.low_normal, low * tile.high_normal),
                        max(high * tile.low_normal, high * tile.high_normal));
  const vec3 longest = max(abs(low), abs(high));
  return most.x + most.y + most.z > -1e-5 * (longest.x + longest.y + longest.z);
}

/// Whether a light may reach the tile.
bool reaches_tile(Light light, TileSurfaces tile) {
  const TileBox box = TileBox(tile.low_world, tile.high_world);
  return kCullLights == 0u || (reaches_box(light, box) && faces_tile(light, tile));
}

/// Lights that reach the tile, of those from `first` to below `end`: 32 at most, one bit each.
uint reaching_lights(uint first, uint end, TileSurfaces tile) {
  uint reaching = 0u, done = 0u;
  do {
    const uint mine = first + done + gl_SubgroupInvocationID;
    const bool reaches = mine < end && reaches_tile(light_from_rows(min(mine, end - 1u)), tile);
    reaching |= subgroupBallot(reaches).x << done;
    done += gl_SubgroupSize;
  } while (first + done < end);
  return reaching;
}

/// Adds the reflected radiance of up to 32 lights from `first` on, with their shadows and the smoke in between. Shades
/// only lights that shine on some thread's surface: walls occlude many.
void add_lights(uint first, uint lights, bool lit, Surface surface, vec3 view, inout vec3 radiance) {
  const vec2 texel_uv = 1.0 / vec2(textureSize(smoke_shadows, 0));
  do {
    uint index;
    vec3 intensity;
    LightOnSurface on;
    float received;  // past surfaces
    do {
      index = first + uint(findLSB(lights));
      lights &= lights - 1u;
      const Light light = light_from_rows(index);
      intensity = light.intensity;
      on = light_on_surface(light, surface.position_world, surface.normal);
      received = on.received * visibility_on_surface(light, on);
    } while (lights != 0u && !subgroupAny(lit && received > 0.0));
    if (received > 0.0)
      radiance += reflectance(surface, view, on.to_light) * intensity *
                  (received * smoke_transmittance(index, on.on_face, texel_uv));
  } while (lights != 0u);
}

/// Reflected radiance of all lights, summed in their order whatever the subgroup size. Loops test at their end: where
/// the test comes first, a software rasteriser runs the body once more, for no thread.
vec3 lights_radiance(bool lit, Surface surface, vec3 view) {
  const TileSurfaces tile = surfaces_of_tile(lit, surface.position_world, surface.normal);
  const uint light_count = subgroupAny(lit) ? frame.light_count : 0u;
  vec3 radiance = vec3(0.0);
  uint first = 0u;
  if (light_count > 0u) {
    do {
      const uint lights = reaching_lights(first, min(first + 32u, light_count), tile);
      if (lights != 0u) add_lights(first, lights, lit, surface, view, radiance);
      first += 32u;
    } while (first < light_count);
  }
  return radiance;
}

void main() {
  // Z order: the pixels of a subgroup of any size are close together.
  const uint i = gl_LocalInvocationIndex;
  const uvec2 in_group =
      uvec2((i & 1u) | (i >> 1u & 2u) | (i >> 2u & 4u), (i >> 1u & 1u) | (i >> 2u & 2u) | (i >> 3u & 4u));
  const ivec2 px = ivec2(kGroup * gl_WorkGroupID.xy + in_group);
  const bool inside = all(lessThan(uvec2(px), frame.size_px));
  const vec3 ray = camera_ray(frame.camera, vec2(px) + 0.5, frame.size_px);
  const vec4 over = inside ? texelFetch(smoke, px, 0) : vec4(0.0);
  const float d = inside ? texelFetch(depth, px, 0).r : 0.0;
  const bool visible = over.a > 0.0, lit = visible && d > 0.0;

  const vec4 a = texelFetch(albedo_roughness, px, 0), n = texelFetch(normal_metallic, px, 0);
  const vec3 position_world = frame.camera.eye_world + view_distance(frame.camera, d) * ray;
  const Surface surface = Surface(position_world, normalize(n.xyz), a.rgb, a.a, metallic_of(n.a));
  vec3 radiance = lights_radiance(lit, surface, -normalize(ray));
  if (lit) {
    const vec3 emitted = texelFetch(emission, px, 0).rgb;
    const vec3 arriving = frame.indirect.bounces > 0u
                              ? indirect_irradiance(surface.position_world, surface.normal)
                              : frame.sky.ambient * sky_irradiance(surface.position_world, surface.normal);
    const vec3 ambient = surface.albedo * arriving;
    if (kDecals == 0u)
      radiance += emitted + ambient;
    else
      radiance = emitted + (radiance + ambient) * (1.0 - texelFetch(decal_occlusion, px, 0).r);
  } else {
    radiance = visible ? sky_radiance(frame.sky, normalize(ray)) : vec3(0.0);
  }
  if (!inside) return;
  const vec3 seen = over.rgb + over.a * radiance;
  imageStore(radiance_image, px, vec4(seen, 1.0));
  if (kDisplays != 0u) imageStore(display, px, displayed(px, seen, 1.0));
}
