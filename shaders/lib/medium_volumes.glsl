// Volumes besides the smoke as a medium of lib/media.glsl: bricks of densities under any affine transform, lit by the
// grids of shared/volume_light.h, and glowing where they are hot.
#ifndef MEDIUM_VOLUMES_GLSL
#define MEDIUM_VOLUMES_GLSL
#include "lib/frame.glsl"
#include "lib/volume_values.glsl"
#include "shared/phase.h"

layout(binding = kBindVolumeLight) uniform sampler3D volume_light;
layout(binding = kBindVolumeColors) uniform sampler2D volume_colors;

struct VolumesSpan {
  uint present;  // bit i: samples in [t_first, t_stop) may be inside volume i
  float t_first, t_stop, t_next;
};

/// The span of one volume: a brick, an empty cube, or all samples before or behind its bounds.
BrickSpan volume_span(uint i, WorldRay world, float t, float ds) {
  const VoxelRay ray = VoxelRay(volumes[i].voxel_from_world * vec4(world.origin, 1.0),
                                volumes[i].voxel_from_world * vec4(world.direction, 0.0));
  const vec2 inside = span_in_box(ray, volumes[i].bounds_min, volumes[i].bounds_max);
  if (inside.x >= inside.y || t >= inside.y) return BrickSpan(vec3(0.0), kNoSlot, t, t, 1e30);
  const float t_inside = sample_from(inside.x, t, ds);
  if (t_inside > t) return BrickSpan(vec3(0.0), kNoSlot, t, t, t_inside);
  const vec3 brick = brick_of(ray, t);
  int empty_edge;
  const uint slot = volume_slot_at(volumes[i].bricks, ivec3(brick), empty_edge);
  return brick_span(ray, brick, slot, empty_edge, t, ds);
}

VolumesSpan volumes_span(WorldRay ray, float t, float ds) {
  VolumesSpan span = VolumesSpan(0u, t, t, 1e30);
  for (uint i = 0u; i < frame.media.volume_count; ++i) {
    const BrickSpan bricks = volume_span(i, ray, t, ds);
    span.t_next = min(span.t_next, bricks.t_next);
    if (bricks.slot != kNoSlot) span.present |= 1u << i;
  }
  if (span.present != 0u) span.t_stop = span.t_next - 0.5 * ds;
  return span;
}

/// Sums over the volumes.
struct VolumesSample {
  float extinction;  // [1/m]
  vec3 light;        // extinction times radiance towards the eye
  vec3 glow;         // radiance that leaves per metre, whatever the extinction
};

/// Radiance towards the eye that a volume scatters, per extinction: from its cube of the light, in its bounds.
vec3 volume_inscatter(uint i, vec3 p_voxel, float cos_angle) {
  const vec3 size = vec3(textureSize(volume_light, 0));
  const vec3 at = (p_voxel - volumes[i].bounds_min) / (volumes[i].bounds_max - volumes[i].bounds_min);
  const vec3 texel = vec3(0.0, 0.0, float(i) * size.x) + clamp(at * size.x, vec3(0.5), vec3(size.x - 0.5));
  const vec4 light = textureLod(volume_light, texel / size, 0.0);
  const VolumeLook look = volumes[i].look;
  return light.rgb + look.albedo * frame.media.sun_irradiance *
                         (light.a * henyey_greenstein(look.anisotropy, cos_angle));
}

/// What a volume's heat emits at a point, per metre and per look.extinction.
vec3 volume_glow(uint i, vec3 p_world) {
  const float heat = volume_value(volumes[i].heat.bricks, volumes[i].heat.voxel_from_world * vec4(p_world, 1.0));
  if (heat <= 0.0) return vec3(0.0);
  const vec2 size = vec2(textureSize(volume_colors, 0));
  const float column = clamp(heat * volumes[i].heat.per_value, 0.0, 1.0) * (size.x - 1.0) + 0.5;
  return textureLod(volume_colors, vec2(column, float(i) + 0.5) / size, 0.0).rgb;
}

VolumesSample sample_volumes(VolumesSpan span, WorldRay ray, vec3 p_world, inout uint texture_samples) {
  VolumesSample sum = VolumesSample(0.0, vec3(0.0), vec3(0.0));
  const float cos_angle = dot(frame.media.to_sun, ray.direction);
  for (uint left = span.present; left != 0u; left &= left - 1u) {
    const uint i = uint(findLSB(left));
    const vec3 p_voxel = volumes[i].voxel_from_world * vec4(p_world, 1.0);
    const float extinction = volumes[i].look.extinction * volume_value(volumes[i].bricks, p_voxel);
    ++texture_samples;
    if (extinction > 0.0) {
      sum.extinction += extinction;
      sum.light += extinction * (volume_inscatter(i, p_voxel, cos_angle) + volumes[i].look.emission);
      ++texture_samples;
    }
    if (volumes[i].heat.per_value > 0.0) {
      sum.glow += volumes[i].look.extinction * volume_glow(i, p_world);
      ++texture_samples;
    }
  }
  return sum;
}

#endif
