// Marches rays through the smoke: premultiplied radiance and transmittance.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define BINDING_PAGES 1
#define BINDING_DENSITY 2
#define BINDING_CELLS 3
#define BINDING_BOUNDARY 4
#define BINDING_CORNERS 5
#define BINDING_HOLES 10
#define BINDING_HOLE_MASKS 15
#define BINDING_HOLE_GRID 16
#include "lib/blue_noise.glsl"
#include "lib/camera.glsl"
#include "lib/erosion.glsl"
#include "lib/smoke_density.glsl"
#include "shared/frame.h"
#include "shared/resolve.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint kCountSamples = 0u;
layout(constant_id = 1) const uint kRays = kRaysOfPixels;
const uint kRuns = kRays == kRaysOfBlocks ? 2u : 1u;
layout(scalar, binding = 0) readonly buffer Frame { FrameConstants frame; };
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
layout(binding = 18) uniform sampler3D drift_atlas;
#include "lib/holes.glsl"

/// What noise and holes leave of the density at a point of a brick.
float carved(float density, uint holes_here, vec3 local_voxel, vec3 uvw, vec3 p_world) {
  const vec3 drift = textureLod(drift_atlas, uvw, 0.0).xyz;
  const vec4 noise = smoke_noise(noise_tile, frame.look, p_world + drift, frame.time);
  if (frame.look.erosion > 0.0) density = erode(frame.look, density, noise);
  if (any_holes(holes_here) && density > 0.0) {
    density *= left_by_holes(holes_here, local_voxel, p_world, (2.0 * noise.g - 1.0) * frame.look.hole_rim);
  }
  return density;
}

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

void main() {
  Way way;
  if (!find_way(way)) return;
  const SmokeVolumeFrame volume = frame.volume;

  // The ray in voxels, t in metres; it ends at the surface behind.
  const vec3 ray = camera_ray(frame.camera, way.position_px, frame.size_px);
  const vec3 direction = normalize(ray);
  const vec3 origin = (frame.camera.eye_world - volume.origin_world) / volume.voxel_size;
  const vec3 per_metre = direction / volume.voxel_size;
  const vec3 inverse = 1.0 / (per_metre + vec3(equal(per_metre, vec3(0.0))) * 1e-9);

  // The part inside the smoke's bounds.
  const vec3 t0 = (volume.bounds_min - origin) * inverse, t1 = (volume.bounds_max - origin) * inverse;
  const vec3 near = min(t0, t1), far = max(t0, t1);
  const float t_begin = max(max(near.x, near.y), max(near.z, 0.0));
  const float t_last = min(min(far.x, far.y), min(far.z, way.far * length(ray)));
  vec3 radiance = vec3(0.0);
  float transmittance = 1.0;
  vec4 at_near = vec4(0.0, 0.0, 0.0, 1.0);
  uint samples = 0u;
  if (t_begin < t_last) {
    const float jitter = blue_noise(blue_noise_tile, way.texel, frame.frame_index).r;
    const float ds = frame.look.step_length;
    const vec3 texel = atlas_texel(volume);
    // Segments of length ds from t_begin on, the last one cut; one sample in each, all at the same share of it. Brick
    // by brick, so that what a brick's samples share is found once.
    float t = t_begin;
    for (uint run = 0u; run < kRuns; ++run) {
      const float t_end = run + 1u < kRuns ? min(t_last, way.near * length(ray)) : t_last;
      for (; t < t_end && transmittance > 0.0;) {
        const vec3 at = origin + per_metre * (t + jitter * min(ds, t_end - t));
        vec3 low = floor(at / float(kBrickVoxels)) * float(kBrickVoxels);
        int edge;
        const uint slot = slot_at(volume, ivec3(low) / kBrickVoxels, edge);
        if (slot == kNoSlot) low = floor(at / float(edge)) * float(edge);
        const vec3 exits = max((low - origin) * inverse, (low + float(edge) - origin) * inverse);
        const float inside = max(1.0, ceil((min(exits.x, min(exits.y, exits.z)) - t) / ds - jitter));
        const float t_next = t + ds * inside;
        if (slot == kNoSlot) {
          t = t_next;
          continue;
        }
        const vec3 corner = atlas_corner(volume, slot);
        const uint holes_here = holes_in_slot(slot);
        const bool noisy = frame.look.erosion > 0.0 || any_holes(holes_here);
        for (const float t_stop = min(t_next - 0.5 * ds, t_end); t < t_stop; t += ds) {
          const float segment = min(ds, t_end - t);
          const vec3 local_voxel = origin + per_metre * (t + jitter * segment) - low;
          const vec3 uvw = (corner + local_voxel) * texel;
          const SmokeSample here = sample_brick(slot, local_voxel, uvw);
          float density = here.density;
          ++samples;
          if (density > 0.0 && noisy) {
            density = carved(density, holes_here, local_voxel, uvw, volume.origin_world + (low + local_voxel) * volume.voxel_size);
            samples += 2u;
          }
          if (density > 0.0) {
            // In-scatter is constant over the segment, so its integral is exact: no step length changes the energy.
            const float passed = exp(-frame.look.extinction * density * segment);
            const vec3 light = textureLod(inscatter_atlas, uvw + here.light_offset * texel, 0.0).rgb;
            radiance += transmittance * (1.0 - passed) * light;
            transmittance *= passed;
            ++samples;
            if (transmittance < frame.look.stop) {
              transmittance = 0.0;
              t = t_end;
            }
          }
        }
      }
      if (run + 1u < kRuns) {
        at_near = vec4(radiance * frame.look.albedo, transmittance);
        t = max(t_begin, t_end);
      }
    }
    radiance *= frame.look.albedo;
  }
  imageStore(smoke, way.texel, vec4(radiance, transmittance));
  if (kRuns > 1u) imageStore(smoke_near, way.texel, at_near);
  if (kCountSamples != 0u) atomicAdd(texture_samples, samples);
}
