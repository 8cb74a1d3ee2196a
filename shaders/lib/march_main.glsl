// Marches rays through the media of a frame: the entry point of march.comp and march_several.comp, which differ in
// kByBlocks. They are two shaders because a driver compiles all code of a shader, whatever its constants.
#ifndef MARCH_MAIN_GLSL
#define MARCH_MAIN_GLSL
#include "shared/frame.h"
#include "shared/hole_clusters.h"
#include "shared/resolve.h"

layout(local_size_x = kHoleTilePixels, local_size_y = kHoleTilePixels) in;
layout(constant_id = 0) const uint kCount = kCountNothing;
layout(constant_id = 1) const uint kRays = kRaysOfPixels;
layout(constant_id = 2) const uint kHoles = kHolesNone;
layout(constant_id = 3) const uint kMedia = 0u;
layout(constant_id = 4) const uint kBlockSteps = 4u;
layout(constant_id = 5) const uint kSplitByHoles = 0u;  // 1: one pipeline for tiles with holes, one for the others
#include "lib/blue_noise.glsl"
#include "lib/march.glsl"
#include "lib/pixel_ray.glsl"
#include "lib/ray_bounds.glsl"

layout(binding = kBindBlueNoise) uniform sampler2D blue_noise_tile;
layout(binding = kBindSmoke, rgba16f) uniform writeonly image2D smoke;
layout(binding = kBindSmokeNear, rgba16f) uniform writeonly image2D smoke_near;
layout(scalar, binding = kBindMarchCounters) buffer Counters {
  uint texture_samples;
  uint of_pixel[];  // by kCount: the steps of its ray, or the bits of the entry's distance
};

/// Whether the other pipeline marches the rays of this workgroup. Rays of tiles are march_scale pixels apart, so their
/// workgroup covers march_scale^2 tiles of holes.
bool is_of_other_pipeline() {
  const bool split = kSplitByHoles != 0u && kMayHaveHoles && kHoles != kHolesAllTested && kRays != kRaysOfList;
  if (!split || frame.holes.count == 0u) return false;
  const uint edge = kRays == kRaysOfTiles ? frame.march_scale : 1u;
  bool any_hole = false;
  for (uint i = 0u; i < edge * edge; ++i) {
    const uvec2 tile = gl_WorkGroupID.xy * edge + uvec2(i % edge, i / edge);
    any_hole = any_hole || hole_lists[tile.x + frame.holes.tiles_across * tile.y] != 0u;
  }
  return any_hole == (kHoles == kHolesNone);
}

vec4 premultiplied(Gathered gathered) { return vec4(gathered.radiance * media_albedo(), gathered.transmittance); }

/// Writes a value of a ray to the counters of all its pixels.
void write_of_pixels(ivec2 texel, uint value) {
  const uint edge = kRays == kRaysOfTiles ? frame.march_scale : 1u;
  for (uint i = 0u; i < edge * edge; ++i) {
    const uvec2 px = uvec2(texel) * edge + uvec2(i % edge, i / edge);
    if (all(lessThan(px, frame.size_px))) of_pixel[px.x + frame.size_px.x * px.y] = value;
  }
}

void main() {
  PixelRay pixel;
  if (is_of_other_pipeline() || !find_ray(pixel)) return;

  // The part of the ray inside the bounds of the media, t in metres; it ends at the surface behind.
  const vec3 along = camera_ray(frame.camera, pixel.position_px, frame.size_px);
  const vec3 origin = kInParallelView ? camera_origin(frame.camera, pixel.position_px, frame.size_px)
                                      : frame.camera.eye_world;
  const WorldRay ray = WorldRay(origin, normalize(along));
  const MediaRay media = media_ray(ray, pixel.position_px);
  const float jitter = blue_noise(blue_noise_tile, pixel.texel, frame.frame_index).r;
  const float per_depth = length(along);
  const vec2 inside = clip_to_media(ray.origin, ray.direction, pixel.far * per_depth);

  // The ray of a tile is marched in two parts and stored at the end of each, at the nearest and the farthest surface of
  // its pixels. In a loop, because compilers inline each call of march.
  const bool of_tile = kRays == kRaysOfTiles;
  const float t_near = of_tile ? clamp(pixel.near * per_depth, inside.x, inside.y) : inside.y;
  Gathered gathered = nothing_gathered();
  vec4 at_near = vec4(0.0, 0.0, 0.0, 1.0);
  for (uint part = 0u; part < (of_tile ? 2u : 1u) && inside.x < inside.y && gathered.transmittance > 0.0; ++part) {
    march(ray, media, jitter, part == 0u ? inside.x : t_near, part == 0u ? t_near : inside.y, gathered);
    if (of_tile && part == 0u) at_near = premultiplied(gathered);
  }

  imageStore(smoke, pixel.texel, premultiplied(gathered));
  if (kRays == kRaysOfTiles) imageStore(smoke_near, pixel.texel, at_near);
  if (kCount == kCountSamples || kCount == kCountSteps) atomicAdd(texture_samples, gathered.texture_samples);
  if (kCount == kCountSteps) write_of_pixels(pixel.texel, gathered.steps);
  if (kCount == kCountEntries) write_of_pixels(pixel.texel, floatBitsToUint(gathered.entry));
}

#endif
