// Marches rays through the smoke: premultiplied radiance and transmittance.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define BINDING_PAGES 1
#define BINDING_CELLS 3
#define BINDING_BOUNDARY 4
#define BINDING_CORNERS 5
#define BINDING_HOLES 10
#define BINDING_HOLE_MASKS 15
#define BINDING_HOLE_LISTS 16
#include "lib/blue_noise.glsl"
#include "lib/camera.glsl"
#include "lib/erosion.glsl"
#include "lib/ray_samples.glsl"
#include "lib/smoke_bricks.glsl"
#include "shared/frame.h"
#include "shared/resolve.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint kCountSamples = 0u;
layout(constant_id = 1) const uint kRays = kRaysOfPixels;
layout(constant_id = 2) const uint kHoles = kHolesNone;
const uint kRuns = kRays == kRaysOfBlocks ? 2u : 1u;
layout(scalar, binding = 0) readonly buffer Frame { FrameConstants frame; };
layout(binding = 2) uniform sampler3D medium_atlas;
layout(binding = 6) uniform sampler3D inscatter_atlas;
layout(binding = 7) uniform sampler3D noise_tile;
layout(binding = 8) uniform sampler2D depth;
layout(binding = 9) uniform sampler2D blue_noise_tile;
layout(binding = 11, rgba16f) uniform writeonly image2D smoke;
layout(scalar, binding = 12) buffer Counters { uint texture_samples; };
layout(scalar, binding = 13) readonly buffer Ends { RayEnds ends[]; };
layout(binding = 14, rgba16f) uniform writeonly image2D smoke_near;
layout(scalar, binding = 17) readonly buffer List {
  MarchList list;
  uint listed[];  // blocks
};
#include "lib/ray_holes.glsl"

/// Where a ray runs. It is looked at in two places: at its last surface, and at the nearest of its block.
struct Way {
  ivec2 texel;       // of the pictures that are written
  vec2 position_px;  // in the whole picture
  float near, far;   // distances along the view axis
};

/// False where there is no ray.
bool find_way(out Way way) {
  way.texel = ivec2(gl_GlobalInvocationID.xy);
  if (kRays == kRaysOfBlocks) {
    const uvec2 blocks = blocks_of(frame.size_px, frame.march_scale);
    if (any(greaterThanEqual(uvec2(way.texel), blocks))) return false;
    const RayEnds e = ends[uint(way.texel.x) + blocks.x * uint(way.texel.y)];
    way.position_px = e.position_px;
    way.near = e.near;
    way.far = e.far;
    return true;
  }
  if (kRays == kRaysOfList) {
    const uint group = gl_WorkGroupID.x + kListedRow * gl_WorkGroupID.y;
    const uint index = group * 64u + gl_LocalInvocationIndex, scale = frame.march_scale;
    const uint entry = index / (scale * scale), pixel = index % (scale * scale);
    if (entry >= list.count) return false;
    const uint across = blocks_of(frame.size_px, scale).x;
    way.texel = ivec2(uvec2(listed[entry] % across, listed[entry] / across) * scale + uvec2(pixel % scale, pixel / scale));
  }
  if (any(greaterThanEqual(uvec2(way.texel), frame.size_px))) return false;
  way.position_px = vec2(way.texel) + 0.5;
  way.near = way.far = view_distance(frame.camera, texelFetch(depth, way.texel, 0).r);
  return true;
}

/// What a ray has gathered.
struct Gathered {
  vec3 radiance;
  float transmittance;
  uint samples;
};

/// A brick, or the cube without smoke around it, on the way of a ray.
struct Stay {
  vec3 low;  // low corner [voxels]
  uint slot;
  float t_next;  // where the first segment begins whose sample lies behind it
};

Stay find_stay(RaySamples ray, vec3 origin, vec3 per_metre, vec3 inverse, float t) {
  const vec3 at = origin + per_metre * (t + ray.jitter * min(ray.ds, ray.end - t));
  Stay stay;
  stay.low = floor(at / float(kBrickVoxels)) * float(kBrickVoxels);
  int edge;
  stay.slot = slot_at(frame.volume, ivec3(stay.low) / kBrickVoxels, edge);
  if (stay.slot == kNoSlot) stay.low = floor(at / float(edge)) * float(edge);
  else edge = kBrickVoxels;
  const vec3 exits = max((stay.low - origin) * inverse, (stay.low + float(edge) - origin) * inverse);
  stay.t_next = t + ray.ds * max(1.0, ceil((min(exits.x, min(exits.y, exits.z)) - t) / ray.ds - ray.jitter));
  return stay;
}

/// Marches segments of length ds, the last one cut; one sample in each, all at the same share of it. Brick by brick, so
/// that what a brick's samples share is found once.
void march(RaySamples ray, vec2 position_px, inout Gathered got) {
  const SmokeVolumeFrame volume = frame.volume;
  const vec3 origin = (ray.origin_world - volume.origin_world) / volume.voxel_size;
  const vec3 per_metre = ray.direction / volume.voxel_size;
  const vec3 inverse = 1.0 / (per_metre + vec3(equal(per_metre, vec3(0.0))) * 1e-9);
  const vec3 texel = atlas_texel(volume);
  const RayHoles holes = holes_of_ray(position_px);
  float t = ray.begin;
  while (t < ray.end && got.transmittance > 0.0) {
    const Stay stay = find_stay(ray, origin, per_metre, inverse, t);
    if (stay.slot == kNoSlot) {
      t = stay.t_next;
      continue;
    }
    const vec3 corner = atlas_corner(volume, stay.slot);
    const float t_stop = min(stay.t_next - 0.5 * ray.ds, ray.end);
    for (; t < t_stop; t += ray.ds) {
      const float segment = min(ray.ds, ray.end - t);
      const float t_sample = t + ray.jitter * segment;
      const vec3 local_voxel = origin + per_metre * t_sample - stay.low;
      const vec3 uvw = (corner + local_voxel) * texel;
      const vec4 medium = textureLod(medium_atlas, uvw, 0.0);
      SmokeSample here = SmokeSample(medium.r, vec3(0.0));
      if (medium.r < 0.0) here = boundary_sample(stay.slot, local_voxel);
      float density = here.density;
      ++got.samples;
      if (density > 0.0 && (kHoles != kHolesNone || frame.look.erosion > 0.0)) {
        const vec3 p_world = volume.origin_world + (stay.low + local_voxel) * volume.voxel_size;
        const vec4 noise = smoke_noise(noise_tile, frame.look, p_world + medium.gba, frame.time);
        ++got.samples;
        if (frame.look.erosion > 0.0) density = erode(frame.look, density, noise);
        if (kHoles != kHolesNone) density *= left_by_holes(holes, t_sample, p_world, 2.0 * noise.g - 1.0, density > 0.0);
      }
      if (density > 0.0) {
        // In-scatter is constant over the segment, so its integral is exact: no step length changes the energy.
        const float passed = exp(-frame.look.extinction * density * segment);
        const vec3 light = textureLod(inscatter_atlas, uvw + here.light_offset * texel, 0.0).rgb;
        ++got.samples;
        got.radiance += got.transmittance * (1.0 - passed) * light;
        got.transmittance *= passed;
        if (got.transmittance < frame.look.stop) {
          got.transmittance = 0.0;
          t = ray.end;
        }
      }
    }
  }
}

void main() {
  Way way;
  if (!find_way(way)) return;
  const SmokeVolumeFrame volume = frame.volume;

  // The part of the ray inside the smoke's bounds, t in metres; it ends at the surface behind.
  const vec3 along = camera_ray(frame.camera, way.position_px, frame.size_px);
  RaySamples ray;
  ray.origin_world = frame.camera.eye_world;
  ray.direction = normalize(along);
  ray.ds = frame.look.step_length;
  ray.jitter = blue_noise(blue_noise_tile, way.texel, frame.frame_index).r;
  const vec3 inverse = 1.0 / (ray.direction + vec3(equal(ray.direction, vec3(0.0))) * 1e-9);
  const vec3 low = volume.origin_world + volume.bounds_min * volume.voxel_size - ray.origin_world;
  const vec3 high = volume.origin_world + volume.bounds_max * volume.voxel_size - ray.origin_world;
  const vec3 near = min(low * inverse, high * inverse), far = max(low * inverse, high * inverse);
  const float t_begin = max(max(near.x, near.y), max(near.z, 0.0));
  const float t_last = min(min(far.x, far.y), min(far.z, way.far * length(along)));
  Gathered got = Gathered(vec3(0.0), 1.0, 0u);
  vec4 at_near = vec4(0.0, 0.0, 0.0, 1.0);
  if (t_begin < t_last) {
    ray.begin = t_begin;
    for (uint run = 0u; run < kRuns; ++run) {
      ray.end = run + 1u < kRuns ? min(t_last, way.near * length(along)) : t_last;
      march(ray, way.position_px, got);
      if (run + 1u < kRuns) {
        at_near = vec4(got.radiance * frame.look.albedo, got.transmittance);
        ray.begin = max(t_begin, ray.end);
      }
    }
  }
  imageStore(smoke, way.texel, vec4(got.radiance * frame.look.albedo, got.transmittance));
  if (kRuns > 1u) imageStore(smoke_near, way.texel, at_near);
  if (kCountSamples != 0u) atomicAdd(texture_samples, got.samples);
}
