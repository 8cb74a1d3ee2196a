// Smooths the light of the probes: a neighbourhood of 3^3 cells has the rays of all phases in equal parts, so what
// differs from phase to phase averages out. In dense media that would spread light too far.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/indirect_cells.glsl"

layout(local_size_x = 64) in;
layout(binding = kBindIndirectCube) uniform sampler3D noisy_cube;
layout(binding = kBindMediumMatter) uniform sampler3D medium_matter;
layout(binding = kBindIndirectTarget, rgba16f) uniform image3D target;
layout(scalar, push_constant) uniform Push { IndirectParams params; };

void main() {
  const uint index = gl_GlobalInvocationID.x;
  const ivec3 size = frame.indirect.size;
  if (index >= uint(size.x * size.y * size.z)) return;
  const ivec3 cell = cell_at(frame.indirect, index);
  const float extinction = params.media_low.x < params.media_high.x ? texelFetch(medium_matter, cell, 0).a : 0.0;
  // The share of what a neighbour counts in air: none where light is scattered within a few cells.
  const float shared_light = exp(-8.0 * extinction * frame.indirect.cell_size);
  vec4 sums[kIndirectSlabs];
  for (uint slab = 0u; slab < kIndirectSlabs; ++slab) sums[slab] = vec4(0.0);
  for (int i = 0; i < 27; ++i) {
    const ivec3 step = ivec3(i % 3, i / 3 % 3, i / 9) - 1, at = cell + step, far = abs(step);
    if (any(lessThan(at, ivec3(0))) || any(greaterThanEqual(at, size))) continue;
    // Light changes fast at the border of a medium.
    if (extinction > 0.0 && texelFetch(medium_matter, at, 0).a <= 0.0) continue;
    // Binomial weights; solid cells have an alpha of 0.
    const float weight = (step == ivec3(0) ? 1.0 : shared_light) / float(1 << (far.x + far.y + far.z));
    for (uint slab = 0u; slab < kIndirectSlabs; ++slab)
      sums[slab] += weight * texelFetch(noisy_cube, at + ivec3(0, 0, int(slab) * size.z), 0);
  }
  if (sums[0].a <= 0.0) return;
  const float alpha = texelFetch(noisy_cube, cell, 0).a > 0.0 ? 1.0 : kSolidWeight;
  for (uint slab = 0u; slab < kIndirectSlabs; ++slab) {
    const ivec3 at = cell + ivec3(0, 0, int(slab) * size.z);
    if (sums[slab].a <= 0.0) continue;
    const vec3 light = alpha * sums[slab].rgb / sums[slab].a, before = imageLoad(target, at).rgb;
    imageStore(target, at, vec4(max(mix(before, light, slab >= kLightSlabs ? 1.0 : params.relaxation), 0.0), alpha));
  }
}
