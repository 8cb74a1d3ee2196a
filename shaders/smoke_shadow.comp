// The atlas of shared/smoke_shadow.h: a ray a texel, from the light through the smoke to the first surface.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define BINDING_PAGES 4
#define BINDING_DENSITY 5
#define BINDING_CELLS 6
#define BINDING_BOUNDARY 7
#define BINDING_CORNERS 8
#define BINDING_HOLE_CELLS 11
#define BINDING_SOLID 13
#include "shared/frame.h"
#include "shared/light.h"
#include "shared/smoke_shadow.h"

layout(local_size_x = kSmokeShadowBlock, local_size_y = kSmokeShadowBlock) in;
layout(scalar, binding = 0) readonly buffer Frame { FrameConstants frame; };
layout(scalar, binding = 1) readonly buffer Lights { Light lights[]; };
layout(scalar, binding = 2) readonly buffer Views { ShadowView sun; };
layout(binding = 3) uniform sampler2DArray shadows;
layout(binding = 9) uniform sampler3D share_atlas;
layout(binding = 10, r16f) uniform writeonly image2D smoke_shadows;
layout(scalar, binding = 12) readonly buffer Faces { SmokeShadowFace faces[]; };
layout(push_constant, scalar) uniform Push { SmokeShadowParams params; };
layout(binding = 14) readonly buffer Holes { vec4 hole_rows[]; };
layout(binding = 15) uniform sampler2D hole_masks;
#include "lib/hole_reach.glsl"
#include "lib/hole_window.glsl"
#include "lib/optical_depth.glsl"
#include "lib/solid.glsl"

// Holes that the rays of a block may meet; where there are more, their averages over cells do.
const uint kBlockHoles = 64u;
shared uint block_holes[kBlockHoles];
shared uint block_count;

struct Way {
  vec3 from, to;
};

/// The face that a block belongs to: the last one that begins at or before it.
uint face_of(uint block) {
  uint low = 0u, high = params.face_count;
  while (high - low > 1u) {
    const uint middle = (low + high) / 2u;
    if (faces[middle].first_block <= block) low = middle;
    else high = middle;
  }
  return low;
}

/// From a light through a point of one of its faces to the first surface.
Way light_way(Light light, uint face, vec2 uv) {
  const vec2 ndc = uv * 2.0 - 1.0;
  const bool by_voxels = light.shadow_layer == kShadowByVoxels;
  const float depth = by_voxels ? 0.0 : textureLod(shadows, vec3(uv, float(light.shadow_layer + face)), 0.0).r;
  if (light.kind == kLightDirectional) {
    return Way((sun.world_from_clip * vec4(ndc, 1.0, 1.0)).xyz, (sun.world_from_clip * vec4(ndc, depth, 1.0)).xyz);
  }
  const vec3 ray = cube_forward(face) + ndc.x * cube_right(face) - ndc.y * cube_up(face);
  const vec3 far = light.position_world + ray * min(kShadowNear / max(depth, 1e-6), light.range);
  return Way(light.position_world, by_voxels ? first_solid(light.position_world, far) : far);
}

/// Around the ways of a block of texels of a face.
RayCone cone_of_block(Light light, uint face, vec2 low_uv, vec2 high_uv) {
  const Way middle = light_way(light, face, 0.5 * (low_uv + high_uv));
  RayCone cone = RayCone(middle.from, normalize(middle.to - middle.from), 0.0, 0.0, light.kind == kLightDirectional ? 1e4 : light.range);
  for (uint i = 0u; i < 4u; ++i) {
    const Way corner = light_way(light, face, vec2((i & 1u) == 0u ? low_uv.x : high_uv.x, (i & 2u) == 0u ? low_uv.y : high_uv.y));
    const vec3 along = corner.to - corner.from;
    if (light.kind == kLightDirectional) cone.radius = max(cone.radius, length(cross(corner.from - middle.from, cone.axis)));
    else cone.spread = max(cone.spread, length(cross(along, cone.axis)) / max(dot(along, cone.axis), 1e-6));
  }
  return cone;
}

/// Finds the holes of the block. All threads of the workgroup take part.
void find_block_holes(RayCone cone) {
  if (gl_LocalInvocationIndex == 0u) block_count = 0u;
  barrier();
  for (uint i = gl_LocalInvocationIndex; i < frame.holes.count; i += kSmokeShadowBlock * kSmokeShadowBlock) {
    if (!cone_meets_hole(cone, reach_from_rows(i))) continue;
    const uint at = atomicAdd(block_count, 1u);
    if (at < kBlockHoles) block_holes[at] = i;
  }
  barrier();
  // In order, so that equal frames multiply in the same order.
  if (gl_LocalInvocationIndex == 0u) {
    for (uint i = 1u; i < min(block_count, kBlockHoles); ++i) {
      const uint hole = block_holes[i];
      uint to = i;
      for (; to > 0u && block_holes[to - 1u] > hole; --to) block_holes[to] = block_holes[to - 1u];
      block_holes[to] = hole;
    }
  }
  barrier();
}

/// Optical depth along a way, by samples in the middle of equal steps.
float way_depth(Way way) {
  const SmokeVolumeFrame volume = frame.volume;
  const float distance = length(way.to - way.from);
  RaySamples ray;
  ray.origin_world = way.from;
  ray.direction = (way.to - way.from) / max(distance, 1e-6);
  ray.jitter = 0.5;
  const vec3 inverse = 1.0 / (ray.direction + vec3(equal(ray.direction, vec3(0.0))) * 1e-6);
  const vec3 low = volume.origin_world + frame.shading_min * volume.voxel_size - way.from;
  const vec3 high = volume.origin_world + frame.shading_max * volume.voxel_size - way.from;
  const vec3 near = min(low * inverse, high * inverse), far = max(low * inverse, high * inverse);
  ray.begin = max(max(near.x, near.y), max(near.z, 0.0));
  ray.end = min(min(far.x, far.y), min(far.z, distance));
  const float steps = clamp(ceil((ray.end - ray.begin) / params.step_length), 0.0, params.max_steps);
  ray.ds = (ray.end - ray.begin) / max(steps, 1.0);
  const bool holes_near = frame.holes.count > 0u && block_count > 0u, by_cells = holes_near && block_count > kBlockHoles;

  const float per_sample = ray.ds * frame.look.extinction;
  const vec3 origin = (way.from - volume.origin_world) / volume.voxel_size, per_metre = ray.direction / volume.voxel_size;
  float depth = 0.0;
  for (float first = 0.0; first < steps && depth < 10.0; first += float(kAhead)) {
    if (holes_near && !by_cells) {
      begin_ahead();
      for (uint i = 0u; i < block_count; ++i) look_ahead(ray, ray.begin + first * ray.ds, hole_from_rows(block_holes[i]));
    }
    for (float i = 0.0; i < min(steps - first, float(kAhead)) && depth < 10.0; ++i) {
      const vec3 p_voxel = origin + per_metre * (ray.begin + (first + i + 0.5) * ray.ds);
      float density = by_cells ? seen_density(p_voxel) : mean_smoke_at(p_voxel).density;
      if (holes_near && !by_cells) density *= left_at(uint(i));
      depth += per_sample * density;
    }
  }
  return depth;
}

void main() {
  const uint face_index = face_of(gl_WorkGroupID.x);
  const SmokeShadowFace face = faces[face_index];
  const Light light = lights[face_index / kFacesPerLight];
  const uint side = face_index % kFacesPerLight;
  const uint block = gl_WorkGroupID.x - face.first_block, row = smoke_shadow_blocks(face.size).x;
  const uvec2 first = face.first_texel + kSmokeShadowBlock * uvec2(block % row, block / row);
  if (frame.holes.count > 0u) {
    const vec2 low_uv = (vec2(first) - face.offset) / face.scale;
    find_block_holes(cone_of_block(light, side, low_uv, low_uv + float(kSmokeShadowBlock) / face.scale));
  }
  const uvec2 at = first + gl_LocalInvocationID.xy;
  if (any(greaterThanEqual(at, face.first_texel + face.size))) return;
  const Way way = light_way(light, side, (vec2(at) + 0.5 - face.offset) / face.scale);
  imageStore(smoke_shadows, ivec2(at), vec4(exp(-way_depth(way))));
}
