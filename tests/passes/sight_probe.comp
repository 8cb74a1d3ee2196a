// Smoke along given segments in small steps, with holes, by what the march reads with.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define BINDING_PAGES 1
#define BINDING_DENSITY 2
#define BINDING_CELLS 3
#define BINDING_BOUNDARY 4
#define BINDING_CORNERS 5
#include "lib/holes.glsl"
#include "lib/smoke_density.glsl"

struct Segment {
  vec3 a_world, b_world;
};

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Segments { Segment segments[]; };
layout(scalar, binding = 6) readonly buffer Holes { Hole holes[]; };
layout(scalar, binding = 7) writeonly buffer Depths { float depths[]; };
layout(push_constant, scalar) uniform Push {
  SmokeVolumeFrame volume;
  float time;
  uint hole_count;   // at most 32
  float step_voxel;  // at most
};

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= uint(segments.length())) return;
  const Segment s = segments[i];
  const vec3 a = (s.a_world - volume.origin_world) / volume.voxel_size;
  const vec3 way = (s.b_world - volume.origin_world) / volume.voxel_size - a;
  const float reach = length(way);
  const vec3 direction = way / reach;

  uint near = 0u;
  for (uint h = 0u; h < hole_count; ++h) {
    if (hole_near_ray(holes[h], s.a_world, direction * volume.voxel_size, 0.0, reach, 0.0)) near |= 1u << h;
  }
  const float count = ceil(reach / step_voxel), ds = reach / count;
  float sum = 0.0;
  for (float k = 0.0; k < count; ++k) {
    const vec3 p = a + direction * (ds * (k + 0.5));
    float density = smoke_density(volume, p);
    if (density == 0.0) continue;
    const vec3 p_world = volume.origin_world + p * volume.voxel_size;
    for (uint bits = near; bits != 0u; bits &= bits - 1u)
      density *= 1.0 - hole_strength(holes[findLSB(bits)], p_world, time, 0.0);
    sum += density;
  }
  depths[i] = sum * ds;
}
