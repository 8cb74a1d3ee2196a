// Optical depth along parallel rays through the bounds of each volume in view: a thread follows one ray, from the light
// on, through all media (shared/volume_light.h).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "lib/frame.glsl"
#include "shared/volume_light.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint kMedia = 0u;
layout(scalar, binding = kBindSweeps) readonly buffer Sweeps { VolumeSweep sweeps[]; };
layout(binding = kBindDepths, r16f) uniform writeonly image3D depths;
layout(scalar, push_constant) uniform Push { VolumeLightParams params; };
#include "lib/media_extinction.glsl"

/// Beyond it nothing of the light is left, and half floats end at 65504.
const float kMostDepth = 60.0;
/// Beyond all media [m].
const float kFar = 1e6;
/// Steps through each other volume before the bounds.
const uint kStepsBeyond = 32u;

/// Optical depth of what other media there are between the light and the bounds.
float depth_beyond(vec3 enters_world, vec3 to_light) {
  float depth = 0.0;
  // At most once: a software rasteriser skips loops, but pays for branches that it does not take.
  for (bool others = params.is_alone == 0u; others; others = false)
    depth = media_depth(media_point(enters_world), to_light, kFar, depth_steps(1.0, kStepsBeyond));
  return depth;
}

void main() {
  const uvec2 column = gl_GlobalInvocationID.xy;
  if (any(greaterThanEqual(column, uvec2(params.edge)))) return;
  const uint volume = gl_GlobalInvocationID.z / params.sweeps, number = gl_GlobalInvocationID.z % params.sweeps;
  const VolumeSweep sweep = sweeps[volume * kSweepsOfVolume + params.first_sweep + number];
  const vec2 uv = (vec2(column) + 0.5) / float(params.edge);
  const mat4x3 world_from_sweep = matrix_of(sweep.world_from_sweep);
  const vec3 enters = world_from_sweep * vec4(uv, 0.0, 1.0), per_unit = world_from_sweep * vec4(0.0, 0.0, 1.0, 0.0);
  const uint samples = params.edge * kSweepSamples;
  const vec3 step_world = per_unit / float(samples);
  const float ds = sweep.length_m / float(samples);
  const MediaAlong along = media_along(enters, enters + per_unit);
  float depth = depth_beyond(enters, -per_unit / sweep.length_m);
  for (uint k = 0u; k < params.edge; ++k) {
    float cell = 0.0;
    for (uint i = 0u; i < kSweepSamples && depth < kMostDepth; ++i) {
      const float at = (float(k * kSweepSamples + i) + 0.5) / float(samples);
      cell += ds * media_extinction(along, enters + per_unit * at, 0.5 * step_world);
    }
    // Of the middle of the cell.
    const uvec3 at = uvec3(number * params.edge + column.x, column.y, volume * params.edge + k);
    imageStore(depths, ivec3(at), vec4(min(depth + 0.5 * cell, kMostDepth)));
    depth += cell;
  }
}
