// How much smoke each ray of light passes.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define BINDING_PAGES 2
#define BINDING_DENSITY 3
#define BINDING_CELLS 4
#define BINDING_BOUNDARY 5
#define BINDING_CORNERS 6
#define BINDING_HOLE_CELLS 7
#include "lib/lights.glsl"
#include "shared/frame.h"
#include "shared/smoke_light.h"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Frame { FrameConstants frame; };
layout(scalar, binding = 1) readonly buffer SlotBricks { ivec3 slot_bricks[]; };
layout(binding = 8) uniform sampler3D share_atlas;
layout(scalar, binding = 9) readonly buffer Lights { Light lights[]; };
layout(scalar, binding = 10) readonly buffer Texels { uint texels[]; };
layout(scalar, binding = 11) readonly buffer Rays { uint rays[]; };
layout(scalar, binding = 12) buffer RayLight { uint ray_light[]; };
layout(scalar, binding = 13) readonly buffer Counters { SmokeLightCounters counters; };
layout(push_constant, scalar) uniform Push { SmokeLightParams params; };
#include "lib/optical_depth.glsl"
#include "lib/smoke_texels.glsl"

void main() {
  for (uint i = gl_GlobalInvocationID.x; i < counters.rays; i += gl_NumWorkGroups.x * 64u) {
    const uint at = rays[i], ray = at % params.rays_per_texel;
    const vec3 p_voxel = smoke_texel(texels[at / params.rays_per_texel]).position_voxel;
    vec3 direction;
    float distance_m = 1e4, steps = float(params.max_steps);
    if (ray < frame.light_count) {
      const Incident incident = light_at(lights[ray], world_from_voxel(p_voxel));
      direction = incident.to_light;
      distance_m = incident.distance;
    } else {
      direction = sky_ray(ray - frame.light_count);
      steps *= 0.5;
    }
    const float depth = optical_depth(p_voxel, direction, distance_m, steps);
    ray_light[at] = packHalf2x16(vec2(depth, unpackHalf2x16(ray_light[at]).y));
  }
}
