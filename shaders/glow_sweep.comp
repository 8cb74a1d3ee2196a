// Radiance of what glows in a volume along one direction a workgroup, slice by slice: each cell takes what the slice
// before it sends, interpolated (short characteristics: Kunasz and Auer 1988, "Short characteristic integration of
// radiative transfer problems").
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/glow_field.h"
#include "shared/sky_light.h"
#include "shared/volume.h"

layout(local_size_x = kGlowThreads, local_size_y = kGlowThreads) in;
layout(scalar, binding = kBindVolumes) uniform Volumes { VolumeInstance volumes[kMaxVolumes]; };
layout(binding = kBindGlowMatter) uniform sampler3D matter;
layout(binding = kBindGlowSwept, rgba16f) uniform writeonly image3D swept;
layout(scalar, push_constant) uniform Push { GlowFieldParams params; };

/// Radiance of a slice and of the one before it, in half floats: 16 KiB.
shared uvec2 slices[2][kGlowEdge * kGlowEdge];

vec3 radiance_at(uint slice, ivec2 cell) {
  if (any(lessThan(cell, ivec2(0))) || any(greaterThanEqual(cell, ivec2(kGlowEdge)))) return vec3(0.0);
  const uvec2 packed = slices[slice][uint(cell.x) + kGlowEdge * uint(cell.y)];
  return vec3(unpackHalf2x16(packed.x), unpackHalf2x16(packed.y).x);
}

/// Between the centres of the slice's cells.
vec3 radiance_between(uint slice, vec2 at) {
  const ivec2 first = ivec2(floor(at));
  const vec2 part = at - vec2(first);
  return mix(mix(radiance_at(slice, first), radiance_at(slice, first + ivec2(1, 0)), part.x),
             mix(radiance_at(slice, first + ivec2(0, 1)), radiance_at(slice, first + ivec2(1)), part.x), part.y);
}

/// What is left of the light, and what a path emits, in matter that is the same along it.
vec3 along_path(vec3 arriving, vec4 here, float ds) {
  const float depth = here.a * ds;
  // (1 - exp(-depth)) / depth
  const float kept = depth > 1e-2 ? (1.0 - exp(-depth)) / depth : 1.0 - 0.5 * depth;
  return arriving * exp(-depth) + here.rgb * (ds * kept);
}

void main() {
  const uint number = gl_WorkGroupID.x;
  const vec3 direction = sky_direction(number);
  const vec3 cells_per_voxel =
      float(kGlowEdge) / (volumes[params.volume].bounds_max - volumes[params.volume].bounds_min);
  const mat4x3 voxel_from_world = matrix_of(volumes[params.volume].voxel_from_world);
  const vec3 cells_per_metre = voxel_from_world * vec4(direction, 0.0) * cells_per_voxel;
  const vec3 lengths = abs(cells_per_metre);
  const uint w = lengths.x >= max(lengths.y, lengths.z) ? 0u : lengths.y >= lengths.z ? 1u : 2u;
  const uint u = (w + 1u) % 3u, v = (w + 2u) % 3u;
  const float ds = 1.0 / lengths[w];
  const vec3 cells_per_slice = cells_per_metre * ds;
  const vec2 aside = vec2(cells_per_slice[u], cells_per_slice[v]);
  for (uint k = 0u; k < kGlowEdge; ++k) {
    for (uint y = gl_LocalInvocationID.y; y < kGlowEdge; y += kGlowThreads) {
      for (uint x = gl_LocalInvocationID.x; x < kGlowEdge; x += kGlowThreads) {
        ivec3 cell;
        cell[u] = int(x);
        cell[v] = int(y);
        cell[w] = int(cells_per_metre[w] > 0.0 ? k : kGlowEdge - 1u - k);
        // From centre to centre; the first slice from the border on.
        const float path = k == 0u ? 0.5 : 1.0;
        const vec3 middle = (vec3(cell) + 0.5 - 0.5 * path * cells_per_slice) / float(kGlowEdge);
        const vec3 arriving = k == 0u ? vec3(0.0) : radiance_between((k - 1u) & 1u, vec2(x, y) - aside);
        const vec3 radiance = along_path(arriving, textureLod(matter, middle, 0.0), path * ds);
        slices[k & 1u][x + kGlowEdge * y] = uvec2(packHalf2x16(radiance.xy), packHalf2x16(vec2(radiance.z, 0.0)));
        imageStore(swept, cell + ivec3(number * kGlowEdge, 0, 0), vec4(radiance * sky_weight(number), 1.0));
      }
    }
    barrier();
  }
}
