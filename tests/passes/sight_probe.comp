// Optical depth along given segments in small steps, with holes, by the functions of the march.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/hole_mask.glsl"
#include "lib/smoke_density.glsl"
#include "probes.h"

struct Segment {
  PackedVec3 a_world, b_world;
};

layout(local_size_x = 64) in;
layout(scalar, binding = kBindProbeIn) readonly buffer Segments { Segment segments[]; };
layout(scalar, binding = kBindProbeIn2) readonly buffer Holes { Hole holes[]; };
layout(scalar, binding = kBindProbeOut) writeonly buffer Depths { float depths[]; };
const float kStepVoxel = 1.0 / 64.0;  // at most
layout(scalar, binding = kBindProbeIn3) readonly buffer Constants { VolumeLayout volume; };
layout(scalar, push_constant) uniform Push {
  float time;
  uint hole_count;   // at most 32
};

/// False only when no point of the ray between t_begin and t_end can lie in the hole: the distance between the
/// two segments (Ericson 2005, "Real-Time Collision Detection", 5.1.9) against the widest cross-section.
bool hole_near_ray(Hole hole, vec3 origin_world, vec3 direction, float t_begin, float t_end, float rim) {
  const vec3 d1 = direction * (t_end - t_begin), d2 = hole.forward * hole.distance_to_far;
  const vec3 r = origin_world + direction * t_begin - hole.origin_world;
  const float a = dot(d1, d1), e = dot(d2, d2), f = dot(d2, r), c = dot(d1, r), b = dot(d1, d2);
  const float denominator = a * e - b * b;
  float s = denominator > 1e-6 * a * e ? clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0.0;
  float t = (b * s + f) / e;
  if (t < 0.0 || t > 1.0) {
    t = clamp(t, 0.0, 1.0);
    s = clamp((b * t - c) / a, 0.0, 1.0);
  }
  const vec3 gap = r + d1 * s - d2 * t;
  const float reach = 1.4143 * (hole.radius + rim);
  return dot(gap, gap) <= reach * reach;
}

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= uint(segments.length())) return;
  const vec3 a_world = unpacked(segments[i].a_world), b_world = unpacked(segments[i].b_world);
  const vec3 a = (a_world - volume.origin_world) / volume.voxel_size;
  const vec3 segment = (b_world - volume.origin_world) / volume.voxel_size - a;
  const float reach = length(segment);
  const vec3 direction = segment / reach;

  uint near = 0u;
  for (uint h = 0u; h < hole_count; ++h) {
    if (hole_near_ray(holes[h], a_world, direction * volume.voxel_size, 0.0, reach, 0.0)) near |= 1u << h;
  }
  const float count = ceil(reach / kStepVoxel), ds = reach / count;
  float sum = 0.0;
  for (float k = 0.0; k < count; ++k) {
    const vec3 p = a + direction * (ds * (k + 0.5));
    float density = smoke_at(volume, p).density;
    if (density == 0.0) continue;
    const vec3 p_world = volume.origin_world + p * volume.voxel_size;
    for (uint bits = near; bits != 0u; bits &= bits - 1u)
      density *= 1.0 - hole_strength_masked(holes[findLSB(bits)], p_world, time, 0.0);
    sum += density;
  }
  depths[i] = sum * ds;
}
