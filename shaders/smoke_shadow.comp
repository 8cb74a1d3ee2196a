// Fills the atlas of shared/smoke_shadow.h: a ray per texel, from the light through all media to the first surface.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/frame.glsl"
#include "shared/light.h"
#include "shared/smoke_shadow.h"

// Neighbouring threads split a ray: it is little work behind long memory latency.
const uint kRayParts = 4u, kPartSteps = 16u;
const uint kWindowThreads = kRayParts * kSmokeShadowBlock * kSmokeShadowBlock;
layout(local_size_x = kWindowThreads) in;
layout(constant_id = 0) const uint kMedia = 0u;
layout(scalar, binding = kBindLights) readonly buffer Lights { Light lights[]; };
layout(scalar, binding = kBindSun) uniform Views { ShadowView sun; };
layout(binding = kBindShadowMaps) uniform sampler2DArray shadow_maps;
layout(binding = kBindSunMap) uniform sampler2D sun_map;
layout(binding = kBindSmokeShadows, r16f) uniform writeonly image2D smoke_shadows;
layout(scalar, binding = kBindSmokeShadowFaces) readonly buffer Faces { SmokeShadowFace faces[]; };
layout(scalar, push_constant) uniform Push { SmokeShadowParams params; };
#include "lib/hole_reach.glsl"
#include "lib/hole_window.glsl"
#include "lib/media_light.glsl"
#include "lib/solid.glsl"

// Limit of exact holes per block of texels; beyond it their averages over cells are used.
const uint kBlockHoles = 64u;
shared uint found_holes[kBlockHoles], block_holes[kBlockHoles];
shared uint hole_count;
shared float part_depths[kWindowThreads];
shared uint ray_holes[kBlockHoles / 32u * kWindowThreads / kRayParts];  // of block_holes, a bit each

struct RaySegment {
  vec3 from, to;
};

/// The face of a block: the last one whose first block is not beyond it.
uint face_of(uint block) {
  uint low = 0u, high = params.face_count;
  while (high - low > 1u) {
    const uint middle = (low + high) / 2u;
    if (faces[middle].first_block <= block) low = middle;
    else high = middle;
  }
  return low;
}

/// Direction from a light through a point of one of its faces, one unit along the face's axis.
vec3 face_ray(uint face, vec2 uv) {
  const vec2 ndc = uv * 2.0 - 1.0;
  return cube_forward(face) + ndc.x * cube_right(face) - ndc.y * cube_up(face);
}

/// The segment from a light through a point of one of its faces to the first surface.
RaySegment light_segment(Light light, uint face, vec2 uv) {
  if (light.kind == kLightDirectional) {
    const vec2 ndc = uv * 2.0 - 1.0;
    const float depth = textureLod(sun_map, uv, 0.0).r;
    return RaySegment((sun.world_from_clip * vec4(ndc, 1.0, 1.0)).xyz,
                      (sun.world_from_clip * vec4(ndc, depth, 1.0)).xyz);
  }
  const bool by_voxels = light.shadow_layer == kShadowByVoxels;
  const float depth = by_voxels ? 0.0 : textureLod(shadow_maps, vec3(uv, float(light.shadow_layer + face)), 0.0).r;
  const vec3 far = light.position_world + face_ray(face, uv) * min(kShadowNear / max(depth, 1e-6), light.range);
  const vec3 to = by_voxels ? first_solid(light.position_world, far) : far, along = to - light.position_world;
  return RaySegment(light.position_world + along * min(light.radius / max(length(along), 1e-6), 1.0), to);
}

/// A cone around the rays through a rectangle of a face.
RayCone cone_of_block(Light light, uint face, vec2 low_uv, vec2 high_uv) {
  const vec2 middle_uv = 0.5 * (low_uv + high_uv);
  if (light.kind == kLightDirectional) {
    const vec3 from = (sun.world_from_clip * vec4(middle_uv * 2.0 - 1.0, 1.0, 1.0)).xyz;
    const vec3 to_corner = (sun.world_from_clip * vec4((high_uv - low_uv), 0.0, 0.0)).xyz;
    const vec3 to_other = (sun.world_from_clip * vec4((high_uv - low_uv) * vec2(1.0, -1.0), 0.0, 0.0)).xyz;
    return RayCone(from, light.direction, max(length(to_corner), length(to_other)), 0.0, 1e4);
  }
  RayCone cone = RayCone(light.position_world, normalize(face_ray(face, middle_uv)), 0.0, 0.0, light.range);
  for (uint i = 0u; i < 4u; ++i) {
    const vec2 uv = vec2((i & 1u) == 0u ? low_uv.x : high_uv.x, (i & 2u) == 0u ? low_uv.y : high_uv.y);
    const vec3 ray = face_ray(face, uv);
    cone.spread = max(cone.spread, length(cross(ray, cone.axis)) / max(dot(ray, cone.axis), 1e-6));
  }
  return cone;
}

/// Finds the holes of the block. Runs in all threads of the workgroup.
void find_block_holes(RayCone cone) {
  const uint thread = gl_LocalInvocationIndex;
  if (thread == 0u) hole_count = 0u;
  barrier();
  for (uint i = thread; i < frame.holes.count; i += kWindowThreads) {
    if (!cone_meets_hole(cone, reach_at(i))) continue;
    const uint at = atomicAdd(hole_count, 1u);
    if (at < kBlockHoles) found_holes[at] = i;
  }
  barrier();
  // Sorted, so that equal frames multiply in the same order.
  const uint count = min(hole_count, kBlockHoles);
  if (thread < count) {
    uint before = 0u;
    for (uint i = 0u; i < count; ++i) before += found_holes[i] < found_holes[thread] ? 1u : 0u;
    block_holes[before] = found_holes[thread];
  }
  barrier();
}

/// The steps of a ray segment inside the caster bounds.
RaySteps steps_of(RaySegment segment, uint part) {
  const VolumeLayout volume = frame.smoke;
  const float distance = length(segment.to - segment.from);
  RaySteps ray;
  ray.origin_world = segment.from;
  ray.direction = (segment.to - segment.from) / max(distance, 1e-6);
  const vec3 inverse = 1.0 / (ray.direction + vec3(equal(ray.direction, vec3(0.0))) * 1e-6);
  const vec3 low = volume.origin_world + frame.caster_bounds_min * volume.voxel_size - segment.from;
  const vec3 high = volume.origin_world + frame.caster_bounds_max * volume.voxel_size - segment.from;
  const vec3 near = min(low * inverse, high * inverse), far = max(low * inverse, high * inverse);
  ray.begin = max(max(near.x, near.y), max(near.z, 0.0));
  const float inside = max(min(min(far.x, far.y), min(far.z, distance)) - ray.begin, 0.0);
  ray.count = uint(clamp(ceil(inside / params.step_length), 0.0, float(kRayParts * kPartSteps)));
  ray.ds = inside / float(max(ray.count, 1u));
  ray.part = part;
  return ray;
}

/// Cuts the holes of the block out of the thread's samples. The threads of a ray share the test which of them it meets.
/// Runs in all threads of the workgroup.
void cut_holes(RaySteps ray) {
  const uint words = kBlockHoles / 32u, at = gl_LocalInvocationIndex / kRayParts * words;
  if (ray.part < words) ray_holes[at + ray.part] = 0u;
  barrier();
  const uint count = ray.count > 0u ? hole_count : 0u;
  for (uint i = ray.part; i < count; i += kRayParts)
    if (!misses(reach_at(block_holes[i]), ray)) atomicOr(ray_holes[at + i / 32u], 1u << (i & 31u));
  barrier();
  for (uint word = 0u; word < words; ++word)
    for (uint bits = ray_holes[at + word]; bits != 0u; bits &= bits - 1u)
      cut_hole(ray, block_holes[32u * word + uint(findLSB(bits))]);
}

/// Optical depth of the thread's part of the steps.
float part_depth(RaySteps ray) {
  const bool any_hole = frame.holes.count > 0u && hole_count > 0u;
  const bool by_cells = any_hole && hole_count > kBlockHoles, by_window = any_hole && !by_cells;
  if (by_window) {
    fill_window();
    cut_holes(ray);
  }
  const float per_sample = ray.ds * frame.look.extinction;
  const vec3 origin = (ray.origin_world - frame.smoke.origin_world) / frame.smoke.voxel_size;
  const vec3 per_metre = ray.direction / frame.smoke.voxel_size;
  float depth = 0.0;
  for (uint i = 0u; kRayParts * i + ray.part < ray.count && depth < 10.0; ++i) {
    const vec3 p_voxel = origin + per_metre * (ray.begin + (float(kRayParts * i + ray.part) + 0.5) * ray.ds);
    float density = by_cells ? cut_smoke_at(p_voxel).density : mean_smoke_at(p_voxel).density;
    if (by_window) density *= remaining_at(i);
    depth += per_sample * density;
  }
  return depth;
}

void main() {
  const uint face_index = face_of(gl_WorkGroupID.x);
  const SmokeShadowFace face = faces[face_index];
  const Light light = lights[face_index / kFacesPerLight];
  const uint side = face_index % kFacesPerLight;
  const uint block = gl_WorkGroupID.x - face.first_block;
  const uint row = smoke_shadow_blocks(face.size, params.spread).x;
  const uint edge = kSmokeShadowBlock * params.spread;
  const uvec2 first = face.first_texel + edge * uvec2(block % row, block / row);
  if (frame.holes.count > 0u) {
    const vec2 low_uv = (vec2(first) - face.offset) / face.scale;
    find_block_holes(cone_of_block(light, side, low_uv, low_uv + float(edge) / face.scale));
  }
  const uint ray = gl_LocalInvocationIndex / kRayParts, part = gl_LocalInvocationIndex % kRayParts;
  const uvec2 at = first + params.first + params.spread * uvec2(ray % kSmokeShadowBlock, ray / kSmokeShadowBlock);
  const RaySegment segment = light_segment(light, side, (vec2(at) + 0.5 - face.offset) / face.scale);
  float mine = kHasSmoke ? part_depth(steps_of(segment, part)) : 0.0;
  const float distance = length(segment.to - segment.from);
  const vec3 direction = (segment.to - segment.from) / max(distance, 1e-6);
  mine += depth_besides_smoke(media_point(segment.from), direction, distance,
                              DepthSteps(1.0, kRayParts * kPartSteps, part, kRayParts));
  part_depths[gl_LocalInvocationIndex] = mine;
  barrier();
  float depth = 0.0;
  for (uint i = 0u; i < kRayParts; ++i) depth += part_depths[kRayParts * ray + i];
  if (part == 0u && all(lessThan(at, face.first_texel + face.size)))
    imageStore(smoke_shadows, ivec2(at), vec4(exp(-depth)));
}
