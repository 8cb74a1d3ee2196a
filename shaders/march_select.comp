// Lists the blocks whose pixels are marched one by one: where what the rays saw cannot be interpolated unseen.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/tone.glsl"
#include "lib/upsample.glsl"
#include "shared/frame.h"
#include "shared/resolve.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, binding = 0) uniform Frame { FrameConstants frame; };
layout(scalar, binding = 1) readonly buffer Ends { RayEnds ends[]; };
layout(binding = 2) uniform sampler2D near;
layout(binding = 3) uniform sampler2D far;
layout(binding = 4) uniform sampler2D emission;
layout(scalar, binding = 5) buffer List {
  MarchList list;
  uint listed[];
};

shared uint group_count, group_first;

RayEnds ends_of(ivec2 block, ivec2 blocks) { return ends[block.x + blocks.x * block.y]; }

bool is_even(RayEnds e) { return e.near_last > e.far_first || e.near == e.far; }

Estimate estimate(RayEnds e, ivec2 block, float z) {
  return at_distance(e, texelFetch(near, block, 0), texelFetch(far, block, 0), z, frame.look, frame.volume.voxel_size);
}

/// How far off the values between two depths can be where only their bounds are known.
vec4 error_between(RayEnds e, ivec2 block, float z) {
  const vec4 fall = abs(texelFetch(far, block, 0) - texelFetch(near, block, 0));
  return fall * min(estimate(e, block, z).doubt / max(fall.a, 1e-4), 1.0);
}

/// What a neighbour says of the smoke in front of a surface at z; on an even surface that goes on there, what it says
/// of its own part of it: the smoke in front of an even surface is even, whatever its slope. `goes_on` is cleared where
/// it does not.
Estimate neighbour(RayEnds own, ivec2 block, ivec2 blocks, float z, inout bool goes_on) {
  block = clamp(block, ivec2(0), blocks - 1);
  const RayEnds e = ends_of(block, blocks);
  const float slack = max(own.far - own.near, e.far - e.near);
  const bool here = is_even(own) && is_even(e) && e.near <= own.far + slack && e.far >= own.near - slack;
  goes_on = goes_on && here;
  return estimate(e, block, here ? 0.5 * (e.near + e.far) : z);
}

/// How far interpolation in front of a surface at z can be off: a quarter of what the values bend by, twice what it is
/// where they bend evenly; where nobody knows this depth on one side, what they rise by over half a block.
///
/// Rays are jittered, and so are full ones: where one surface goes on all around, what bends the same in all four
/// directions counts (a straight edge does in three), less what bends to and fro from ray to ray, as jitter does.
vec4 error_at(RayEnds own, ivec2 block, ivec2 blocks, float z) {
  const ivec2 steps[4] = ivec2[](ivec2(1, 0), ivec2(0, 1), ivec2(1, 1), ivec2(1, -1));
  const vec4 here = estimate(own, block, z).smoke;
  vec4 error = vec4(0.0), sum = vec4(0.0), to_and_fro = vec4(0.0);
  bool goes_on = true;
  for (int i = 0; i < 4; ++i) {
    const Estimate a = neighbour(own, block - steps[i], blocks, z, goes_on);
    const Estimate b = neighbour(own, block + steps[i], blocks, z, goes_on);
    const bool knows_a = a.doubt < kKnown, knows_b = b.doubt < kKnown;
    const vec4 bend = (knows_a ? a.smoke - here : vec4(0.0)) + (knows_b ? b.smoke - here : vec4(0.0));
    error = max(error, (knows_a && knows_b ? 0.25 : 0.5) * abs(bend));
    sum += bend;
    to_and_fro += i < 2 ? -2.0 * bend : bend;
    goes_on = goes_on && knows_a && knows_b;
  }
  return goes_on ? max(abs(sum) - abs(to_and_fro), vec4(0.0)) / 12.0 : error;
}

/// Whether an error of the smoke is seen in front of a surface of this radiance.
bool is_seen(vec4 smoke, vec4 error, vec3 behind) {
  const vec3 right = (smoke.rgb + smoke.a * behind) * frame.exposure;
  const vec3 wrong = right + (error.rgb + error.a * behind) * frame.exposure;
  const vec3 apart = abs(srgb_from_linear(tone_curve(wrong)) - srgb_from_linear(tone_curve(right)));
  return max(apart.r, max(apart.g, apart.b)) > frame.resolve_error;
}

bool must_march(ivec2 block, ivec2 blocks) {
  const RayEnds e = ends_of(block, blocks);
  vec4 error;
  vec4 smoke = texelFetch(far, block, 0);
  if (is_even(e)) {
    const float middle = 0.5 * (e.near + e.far);
    error = max(error_between(e, block, middle), error_at(e, block, blocks, middle));
  } else {
    error = max(error_between(e, block, e.near_last), error_between(e, block, e.far_first));
    error = max(error, max(error_at(e, block, blocks, e.near), error_at(e, block, blocks, e.far)));
  }
  // What shines shows the most of it; surfaces are not lit yet, and taken to be brightly so. In front of a black one
  // the eye sees smaller steps.
  vec3 brightest = vec3(kBrightSurface / frame.exposure);
  const int scale = int(frame.march_scale);
  const ivec2 first = block * scale, last = min(first + scale, ivec2(frame.size_px)) - 1;
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x; x <= last.x; ++x) brightest = max(brightest, texelFetch(emission, ivec2(x, y), 0).rgb);
  }
  return is_seen(smoke, error, vec3(0.0)) || is_seen(smoke, error, brightest);
}

void main() {
  const ivec2 block = ivec2(gl_GlobalInvocationID.xy);
  const ivec2 blocks = ivec2(blocks_of(frame.size_px, frame.march_scale));
  if (gl_LocalInvocationIndex == 0u) group_count = 0u;
  barrier();
  uint index = 0u;
  const bool chosen = all(lessThan(block, blocks)) && must_march(block, blocks);
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
  if (chosen) listed[group_first + index] = uint(block.x + blocks.x * block.y);
}
