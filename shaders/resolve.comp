// Smoke of every pixel, interpolated from the rays of the tiles around it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/frame.glsl"
#include "lib/camera.glsl"
#include "lib/upsample.glsl"
#include "shared/gbuffer.h"
#include "shared/resolve.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = kBindDepth) uniform sampler2D depth;
layout(scalar, binding = kBindRayEnds) readonly buffer Ends { RayEnds ends[]; };
layout(binding = kBindSmokeNear) uniform sampler2D near;
layout(binding = kBindSmokeFar) uniform sampler2D far;
layout(binding = kBindSmoke, rgba16f) uniform writeonly image2D smoke;

void main() {
  const ivec2 px = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(uvec2(px), frame.size_px))) return;
  const ivec2 tiles = ivec2(tiles_of(frame.size_px, frame.march_scale));
  const float z = distance_in_smoke(frame, texelFetch(depth, px, 0).r);

  // The four tiles around the pixel, weighted by distance and by the certainty of their ray at this depth.
  const vec2 place = (vec2(px) + 0.5) / float(frame.march_scale) - 0.5;
  const ivec2 low = ivec2(floor(place));
  const vec2 f = place - vec2(low);
  vec4 sum = vec4(0.0);
  float weights = 0.0;
  for (int i = 0; i < 4; ++i) {
    const ivec2 step = ivec2(i & 1, i >> 1);
    const ivec2 tile = clamp(low + step, ivec2(0), tiles - 1);
    const RayEnds ray = ends[tile.x + tiles.x * tile.y];
    const Estimate e = at_distance(ray, texelFetch(near, tile, 0), texelFetch(far, tile, 0), z, frame.media);
    const vec2 side = mix(1.0 - f, f, vec2(step));
    const float off = e.doubt / kDoubt;
    const float weight = side.x * side.y / (1.0 + off * off);
    sum += weight * e.smoke;
    weights += weight;
  }
  imageStore(smoke, px, sum / weights);
}
