// Lists the tiles whose pixels are marched one by one: those where interpolated rays would show a visible error.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/frame.glsl"
#include "lib/tone.glsl"
#include "lib/upsample.glsl"
#include "shared/gbuffer.h"
#include "shared/resolve.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, binding = kBindRayEnds) readonly buffer Ends { RayEnds ends[]; };
layout(binding = kBindSmokeNear) uniform sampler2D near;
layout(binding = kBindSmokeFar) uniform sampler2D far;
layout(binding = kBindEmission) uniform sampler2D emission;
layout(scalar, binding = kBindMarchList) buffer List {
  MarchList list;
  uint listed[];
};

shared uint group_count, group_first;

RayEnds ends_of(ivec2 tile, ivec2 tiles) { return ends[tile.x + tiles.x * tile.y]; }

bool is_flat(RayEnds e) { return e.near_last > e.far_first || e.near == e.far; }

vec4 fetch_cut(sampler2D smoke, ivec2 tile) {
  const vec4 found = texelFetch(smoke, tile, 0);
  return vec4(found.rgb, usually_cut(frame.media, found.a));
}

Estimate estimate(RayEnds e, ivec2 tile, float z) {
  return at_distance(e, fetch_cut(near, tile), fetch_cut(far, tile), z, frame.media);
}

/// Largest error of the values between two depths of which only bounds are known.
vec4 error_between(RayEnds e, ivec2 tile, float z) {
  const vec4 fall = abs(fetch_cut(far, tile) - fetch_cut(near, tile));
  return fall * min(estimate(e, tile, z).doubt / max(fall.a, 1e-4), 1.0);
}

/// Estimate of a neighbour for the smoke in front of a surface at z. Where the same flat surface continues in both
/// tiles it uses the neighbour's own depth, because smoke in front of a flat surface varies smoothly, whatever the
/// slope. Clears `continues` where the surface does not.
Estimate neighbour(RayEnds own, ivec2 tile, ivec2 tiles, float z, inout bool continues) {
  tile = clamp(tile, ivec2(0), tiles - 1);
  const RayEnds e = ends_of(tile, tiles);
  const float slack = max(own.far - own.near, e.far - e.near);
  const bool here = is_flat(own) && is_flat(e) && e.near <= own.far + slack && e.far >= own.near - slack;
  continues = continues && here;
  return estimate(e, tile, here ? 0.5 * (e.near + e.far) : z);
}

/// Estimated error of interpolation in front of a surface at z: a quarter of the second difference, twice the error of
/// a parabola; where one neighbour is uncertain at this depth, half of the first difference.
///
/// Rays are jittered, as full-resolution rays are: where one surface continues all around, only the second difference
/// common to all four directions counts (a straight edge appears in three), minus the part that alternates from ray to
/// ray as jitter does.
vec4 error_at(RayEnds own, ivec2 tile, ivec2 tiles, float z) {
  const ivec2 steps[4] = ivec2[](ivec2(1, 0), ivec2(0, 1), ivec2(1, 1), ivec2(1, -1));
  const vec4 here = estimate(own, tile, z).smoke;
  vec4 error = vec4(0.0), sum = vec4(0.0), alternating = vec4(0.0);
  bool continues = true;
  for (int i = 0; i < 4; ++i) {
    const Estimate a = neighbour(own, tile - steps[i], tiles, z, continues);
    const Estimate b = neighbour(own, tile + steps[i], tiles, z, continues);
    const bool knows_a = a.doubt < kKnown, knows_b = b.doubt < kKnown;
    const vec4 bend = (knows_a ? a.smoke - here : vec4(0.0)) + (knows_b ? b.smoke - here : vec4(0.0));
    error = max(error, (knows_a && knows_b ? 0.25 : 0.5) * abs(bend));
    sum += bend;
    alternating += i < 2 ? -2.0 * bend : bend;
    continues = continues && knows_a && knows_b;
  }
  return continues ? max(abs(sum) - abs(alternating), vec4(0.0)) / 12.0 : error;
}

/// Whether an error of the smoke is visible in front of a surface of this radiance.
bool is_visible(vec4 smoke, vec4 error, vec3 behind) {
  const vec3 right = (smoke.rgb + smoke.a * behind) * frame.exposure;
  const vec3 wrong = right + (error.rgb + error.a * behind) * frame.exposure;
  const vec3 off = abs(srgb_from_linear(tone_curve(wrong)) - srgb_from_linear(tone_curve(right)));
  return max(off.r, max(off.g, off.b)) > frame.resolve_error;
}

bool must_march(ivec2 tile, ivec2 tiles) {
  const RayEnds e = ends_of(tile, tiles);
  vec4 error;
  vec4 smoke = fetch_cut(far, tile);
  if (is_flat(e)) {
    const float middle = 0.5 * (e.near + e.far);
    error = max(error_between(e, tile, middle), error_at(e, tile, tiles, middle));
  } else {
    error = max(error_between(e, tile, e.near_last), error_between(e, tile, e.far_first));
    error = max(error, max(error_at(e, tile, tiles, e.near), error_at(e, tile, tiles, e.far)));
  }
  if (error == vec4(0.0)) return false;
  // In front of black smaller steps show; emission shows errors most. Other surfaces, not lit yet, are assumed bright.
  if (is_visible(smoke, error, vec3(0.0))) return true;
  vec3 brightest = vec3(kBrightSurface / frame.exposure);
  const int scale = int(frame.march_scale);
  const ivec2 first = tile * scale, last = min(first + scale, ivec2(frame.size_px)) - 1;
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x; x <= last.x; ++x) brightest = max(brightest, texelFetch(emission, ivec2(x, y), 0).rgb);
  }
  return is_visible(smoke, error, brightest);
}

void main() {
  const ivec2 tile = ivec2(gl_GlobalInvocationID.xy);
  const ivec2 tiles = ivec2(tiles_of(frame.size_px, frame.march_scale));
  if (gl_LocalInvocationIndex == 0u) group_count = 0u;
  barrier();
  uint index = 0u;
  const bool chosen = all(lessThan(tile, tiles)) && must_march(tile, tiles);
  if (chosen) index = atomicAdd(group_count, 1u);
  barrier();
  if (gl_LocalInvocationIndex == 0u && group_count > 0u) {
    group_first = atomicAdd(list.count, group_count);
    // Groups of 64 pixels, in rows.
    const uint groups = ((group_first + group_count) * frame.march_scale * frame.march_scale + 63u) / 64u;
    atomicMax(list.groups.x, min(groups, kListedRow));
    atomicMax(list.groups.y, (groups + kListedRow - 1u) / kListedRow);
  }
  barrier();
  if (chosen) listed[group_first + index] = uint(tile.x + tiles.x * tile.y);
}
