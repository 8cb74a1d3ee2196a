// Optical depth along parallel rays through the bounds of each volume in view: a thread follows one ray, from the light
// on, through all media (shared/volume_light.h).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "lib/frame.glsl"
#include "shared/media.h"
#include "shared/volume_light.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint kMedia = kMediumSmoke;
layout(scalar, binding = kBindSweeps) readonly buffer Sweeps { VolumeSweep sweeps[]; };
layout(binding = kBindDepths, r16f) uniform writeonly image3D depths;
layout(scalar, push_constant) uniform Push { VolumeLightParams params; };
#include "lib/optical_depth.glsl"
#include "lib/volume_depth.glsl"
#include "lib/volume_extinction.glsl"

/// Beyond it nothing of the light is left, and half floats end at 65504.
const float kMostDepth = 60.0;
/// Beyond all media [m].
const float kFar = 1e6;
/// Steps through each other volume before the bounds.
const uint kStepsBeyond = 32u;

/// Extinction of the volumes of a mask and of the smoke around the middle of a step [1/m].
float extinction_at(uint mask, vec3 p_world, vec3 step_world) {
  float sum = volumes_extinction(mask, p_world, 0.5 * step_world);
  if ((kMedia & kMediumSmoke) != 0u) {
    const vec3 p_voxel = (p_world - frame.volume.origin_world) / frame.volume.voxel_size;
    if (all(greaterThan(p_voxel, frame.caster_bounds_min)) && all(lessThan(p_voxel, frame.caster_bounds_max)))
      sum += frame.look.extinction * cut_smoke_at(p_voxel).density;
  }
  return sum;
}

/// Optical depth of what other media there are between the light and the bounds.
float depth_beyond(vec3 enters_world, vec3 to_light) {
  float depth = 0.0;
  // At most once: a software rasteriser skips loops, but pays for branches that it does not take.
  for (bool others = params.is_alone == 0u; others; others = false) {
    depth = volumes_depth(enters_world, to_light, kFar, kStepsBeyond, 0u, 1u);
    if ((kMedia & kMediumSmoke) != 0u) {
      const vec3 p_voxel = (enters_world - frame.volume.origin_world) / frame.volume.voxel_size;
      depth += optical_depth(p_voxel, to_light, kFar, 1.0);
    }
  }
  return depth;
}

void main() {
  const uvec2 column = gl_GlobalInvocationID.xy;
  if (any(greaterThanEqual(column, uvec2(params.edge)))) return;
  const uint volume = gl_GlobalInvocationID.z / params.sweeps, number = gl_GlobalInvocationID.z % params.sweeps;
  const VolumeSweep sweep = sweeps[volume * kSweepsOfVolume + params.first_sweep + number];
  const vec2 uv = (vec2(column) + 0.5) / float(params.edge);
  const vec3 enters = sweep.world_from_sweep * vec4(uv, 0.0, 1.0);
  const vec3 per_unit = sweep.world_from_sweep * vec4(0.0, 0.0, 1.0, 0.0);
  const uint samples = params.edge * kSweepSamples;
  const vec3 step_world = per_unit / float(samples);
  const float ds = sweep.length_m / float(samples);
  const uint mask = volumes_along(enters, enters + per_unit);
  float depth = depth_beyond(enters, -per_unit / sweep.length_m);
  for (uint k = 0u; k < params.edge; ++k) {
    float cell = 0.0;
    for (uint i = 0u; i < kSweepSamples && depth < kMostDepth; ++i) {
      const float at = (float(k * kSweepSamples + i) + 0.5) / float(samples);
      cell += ds * extinction_at(mask, enters + per_unit * at, step_world);
    }
    // Of the middle of the cell.
    const uvec3 at = uvec3(number * params.edge + column.x, column.y, volume * params.edge + k);
    imageStore(depths, ivec3(at), vec4(min(depth + 0.5 * cell, kMostDepth)));
    depth += cell;
  }
}
