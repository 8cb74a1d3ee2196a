// Rays of the march: one per pixel, per tile, or per pixel of the listed tiles, by the includer's constant kRays.
#ifndef PIXEL_RAY_GLSL
#define PIXEL_RAY_GLSL
#include "lib/camera.glsl"
#include "lib/frame.glsl"
#include "shared/gbuffer.h"
#include "shared/resolve.h"

layout(binding = kBindDepth) uniform sampler2D depth;
layout(scalar, binding = kBindRayEnds) readonly buffer Ends { RayEnds ends[]; };
layout(scalar, binding = kBindMarchList) readonly buffer List {
  MarchList list;
  uint listed[];  // tiles
};

/// A ray of the camera that is evaluated at two surfaces: the nearest and the farthest of its tile.
struct PixelRay {
  ivec2 texel;       // of the images that are written
  vec2 position_px;  // in the full image
  float near, far;   // distances along the view axis
};

/// False where the thread has no ray.
bool find_ray(out PixelRay ray) {
  ray.texel = ivec2(gl_GlobalInvocationID.xy);
  if (kRays == kRaysOfTiles) {
    const uvec2 tiles = tiles_of(frame.size_px, frame.march_scale);
    if (any(greaterThanEqual(uvec2(ray.texel), tiles))) return false;
    const RayEnds e = ends[uint(ray.texel.x) + tiles.x * uint(ray.texel.y)];
    ray.position_px = e.position_px;
    ray.near = e.near;
    ray.far = e.far;
    return true;
  }
  if (kRays == kRaysOfList) {
    const uint group = gl_WorkGroupID.x + kListedRow * gl_WorkGroupID.y;
    const uint index = group * 64u + gl_LocalInvocationIndex, scale = frame.march_scale;
    const uint entry = index / (scale * scale), pixel = index % (scale * scale);
    if (entry >= list.count) return false;
    const uint across = tiles_of(frame.size_px, scale).x;
    const uvec2 tile = uvec2(listed[entry] % across, listed[entry] / across);
    ray.texel = ivec2(tile * scale + uvec2(pixel % scale, pixel / scale));
  }
  if (any(greaterThanEqual(uvec2(ray.texel), frame.size_px))) return false;
  ray.position_px = vec2(ray.texel) + 0.5;
  ray.near = ray.far = view_distance(frame.camera, texelFetch(depth, ray.texel, 0).r);
  return true;
}

#endif
