// The ray of each tile and the distances that it is marched to, from the depth of the tile's pixels.
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
layout(scalar, binding = kBindRayEnds) writeonly buffer Ends { RayEnds ends[]; };

/// Whether 4 x 4 values of depth lie on one plane: what is linear over the image on every plane has a small residual of
/// a least-squares plane. Reverse depth is, in a parallel view distance.
bool is_flat(vec4 rows[4]) {
  for (int j = 0; j < 4 && frame.camera.parallel != 0.0; ++j)
    for (int i = 0; i < 4; ++i) rows[j][i] = view_distance(frame.camera, rows[j][i]);
  const vec4 x = vec4(-1.5, -0.5, 0.5, 1.5);
  float mean = 0.0, slope_x = 0.0, slope_y = 0.0;
  for (int j = 0; j < 4; ++j) {
    const float sum = dot(rows[j], vec4(1.0));
    mean += sum / 16.0;
    slope_x += dot(rows[j], x) / 20.0;
    slope_y += sum * x[j] / 20.0;
  }
  float off = 0.0;
  vec2 range = vec2(1e9, 0.0);
  for (int j = 0; j < 4; ++j) {
    const vec4 residual = abs(rows[j] - (mean + slope_x * x + slope_y * x[j]));
    off = max(off, max(max(residual.x, residual.y), max(residual.z, residual.w)));
    range.x = min(range.x, min(min(rows[j].x, rows[j].y), min(rows[j].z, rows[j].w)));
    range.y = max(range.y, max(max(rows[j].x, rows[j].y), max(rows[j].z, rows[j].w)));
  }
  return off <= 0.1 * (range.y - range.x) + 1e-4 * range.y;
}

void main() {
  const uvec2 tile = gl_GlobalInvocationID.xy;
  const int scale = int(frame.march_scale);
  const uvec2 tiles = tiles_of(frame.size_px, frame.march_scale);
  if (any(greaterThanEqual(tile, tiles))) return;
  const ivec2 first = ivec2(tile) * scale, last = min(first + scale, ivec2(frame.size_px)) - 1;

  // The tile's depth, with a border of one pixel where it is 2 x 2: two values always lie on a line.
  vec4 rows[4];
  const ivec2 corner = first - (4 - scale) / 2;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) {
      rows[j][i] = texelFetch(depth, clamp(corner + ivec2(i, j), ivec2(0), ivec2(frame.size_px) - 1), 0).r;
    }
  }

  RayEnds e;
  e.position_px = vec2(first) + 0.5 * float(scale);
  e.near = 1e9;
  e.far = 0.0;
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x; x <= last.x; ++x) {
      const float z = distance_in_smoke(frame, rows[y - corner.y][x - corner.x]);
      e.near = min(e.near, z);
      e.far = max(e.far, z);
    }
  }
  e.near_last = e.far;
  e.far_first = e.near;
  const bool differ = (e.far - e.near) * frame.media.extinction > 0.5 * kDoubt;
  if (differ && !is_flat(rows)) {
    // The ray passes the foreground: through the far pixel closest to the centre.
    e.near_last = e.near;
    e.far_first = e.far;
    float nearest = 1e9;
    const vec2 middle = e.position_px;
    for (int y = first.y; y <= last.y; ++y) {
      for (int x = first.x; x <= last.x; ++x) {
        const float z = distance_in_smoke(frame, rows[y - corner.y][x - corner.x]);
        if (2.0 * z < e.near + e.far) {
          e.near_last = max(e.near_last, z);
          continue;
        }
        e.far_first = min(e.far_first, z);
        const vec2 p = vec2(x, y) + 0.5;
        const float off = dot(p - middle, p - middle);
        if (off < nearest) {
          nearest = off;
          e.position_px = p;
        }
      }
    }
  }
  ends[tile.x + tiles.x * tile.y] = e;
}
