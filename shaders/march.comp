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
#include "lib/smoke_bricks.glsl"
#include "shared/frame.h"
#include "shared/resolve.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const uint kCount = kCountNothing;
layout(constant_id = 1) const uint kRays = kRaysOfPixels;
layout(constant_id = 2) const uint kHoles = kHolesNone;
layout(scalar, binding = 0) uniform Frame { FrameConstants frame; };
layout(binding = 2) uniform sampler3D density_displacement_atlas;
layout(binding = 6) uniform sampler3D inscatter_atlas;
layout(binding = 7) uniform sampler3D noise_tile;
layout(binding = 8) uniform sampler2D depth;
layout(binding = 9) uniform sampler2D blue_noise_tile;
layout(binding = 11, rgba16f) uniform writeonly image2D smoke;
layout(scalar, binding = 12) buffer Counters {
  uint texture_samples;
  uint ray_steps[];  // of each pixel's ray
};
layout(scalar, binding = 13) readonly buffer Ends { RayEnds ends[]; };
layout(binding = 14, rgba16f) uniform writeonly image2D smoke_near;
layout(scalar, binding = 17) readonly buffer List {
  MarchList list;
  uint listed[];  // blocks
};
layout(scalar, binding = 18) readonly buffer Filled { uint filled[]; };
#include "lib/ray_holes.glsl"

/// Where a ray runs. It is looked at in two places: at its last surface, and at the nearest of its block.
struct Way {
  ivec2 texel;       // of the pictures that are written
  vec2 position_px;  // in the whole picture
  float near, far;   // distances along the view axis
};

/// False where there is no ray.
bool find_ray(out Way way) {
  way.texel = ivec2(gl_GlobalInvocationID.xy);
  if (kRays == kRaysOfTiles) {
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

struct Ray {
  vec3 origin_world, direction;
  float jitter;
  RayHoles holes;
};

/// What a ray has gathered.
struct Gathered {
  vec3 radiance;
  float transmittance;
  uint samples, steps;  // of textures, of the ray
};

/// A brick, or the cube without smoke around it, on the way of a ray.
struct BrickSpan {
  vec3 low;  // low corner [voxels]
  uint slot;
  float t_first, t_stop;  // samples from the first on, up to the second, may find smoke
  float t_next;           // the first sample behind the brick
};

BrickSpan find_brick_span(Ray ray, float t, float ds) {
  const VolumeLayout volume = frame.volume;
  const vec3 origin = (ray.origin_world - volume.origin_world) / volume.voxel_size, per_metre = ray.direction / volume.voxel_size;
  BrickSpan stay;
  const vec3 brick = floor((origin + per_metre * t) / float(kBrickVoxels));
  int edge;
  stay.slot = slot_at(volume, ivec3(brick), edge);
  if (stay.slot != kNoSlot) edge = kBrickVoxels;
  stay.low = floor(brick * float(kBrickVoxels) / float(edge)) * float(edge);
  const vec3 inverse = 1.0 / (per_metre + vec3(equal(per_metre, vec3(0.0))) * 1e-9);
  const vec3 to_low = (stay.low - origin) * inverse, exits = max(to_low, to_low + float(edge) * inverse);
  stay.t_next = t + ds * max(1.0, ceil((min(exits.x, min(exits.y, exits.z)) - t) / ds));
  stay.t_first = stay.t_stop = t;
  if (stay.slot == kNoSlot) return stay;
  // Cell 0 of a brick begins half a voxel before it.
  const uint cells_filled = filled[stay.slot];
  const vec3 to_first = to_low + (vec3(cells_low(cells_filled)) - 0.5) * inverse, to_end = to_low + (vec3(cells_end(cells_filled)) - 0.5) * inverse;
  const vec3 enters = min(to_first, to_end), leaves = max(to_first, to_end);
  stay.t_first = t + ds * max(0.0, ceil((max(enters.x, max(enters.y, enters.z)) - t) / ds - 1e-3));
  stay.t_stop = min(min(leaves.x, min(leaves.y, leaves.z)) + 1e-3 * ds, stay.t_next - 0.5 * ds);
  return stay;
}

/// Marches the part of a ray between two distances in equal steps of at most the look's length, a sample in each, all at
/// the same share of it. Brick by brick, so that what a brick's samples share is found once; little is kept from step to
/// step, for every register is taken from other rays.
void march(Ray ray, float begin, float end, inout Gathered got) {
  const VolumeLayout volume = frame.volume;
  const float count = ceil((end - begin) / frame.look.step_length), ds = (end - begin) / max(count, 1.0);
  const float after_last = begin + (count - 0.5 + ray.jitter) * ds;
  const vec3 texel = atlas_texel(volume), texels_per_metre = texel / volume.voxel_size;
  const float per_density = -1.44269504 * frame.look.extinction * ds;  // for exp2
  const float periods_per_metre = 1.0 / frame.look.noise_period;
  const vec3 risen = vec3(0.0, frame.look.rise * frame.time * periods_per_metre, 0.0);
  for (float t = begin + ray.jitter * ds; t < after_last;) {
    const BrickSpan stay = find_brick_span(ray, t, ds);
    const vec3 uvw_of_world = (atlas_corner(volume, stay.slot) - stay.low) * texel - volume.origin_world * texels_per_metre;
    const float t_stop = min(stay.t_stop, after_last);
    for (t = stay.t_first; t < t_stop; t += ds) {
      const vec3 p_world = ray.origin_world + ray.direction * t;
      const vec3 uvw = p_world * texels_per_metre + uvw_of_world;
      const vec4 medium = textureLod(density_displacement_atlas, uvw, 0.0);
      SmokeSample here = SmokeSample(medium.r, vec3(0.0));
      if (medium.r < 0.0) here = boundary_sample(stay.slot, (p_world - volume.origin_world) / volume.voxel_size - stay.low);
      float density = here.density;
      ++got.samples;
      ++got.steps;
      if (density > 0.0 && (kHoles != kHolesNone || frame.look.erosion > 0.0)) {
        const vec4 noise = textureLod(noise_tile, (p_world + medium.gba) * periods_per_metre - risen, 0.0);
        ++got.samples;
        if (frame.look.erosion > 0.0) density = erode(frame.look, density, noise);
        if (kHoles != kHolesNone) density *= remaining_after_holes(ray.holes, t, p_world, 2.0 * noise.g - 1.0, density > 0.0);
      }
      if (density > 0.0) {
        // In-scatter is constant over the step, so its integral is exact: no step length changes the energy.
        const float passed = exp2(per_density * density);
        const vec3 light = textureLod(inscatter_atlas, uvw + here.light_offset * texel, 0.0).rgb;
        ++got.samples;
        got.radiance += got.transmittance * (1.0 - passed) * light;
        got.transmittance *= passed;
        if (got.transmittance < frame.look.opaque_transmittance) {
          got.transmittance = 0.0;
          return;
        }
      }
    }
    t = stay.t_next;
  }
}

/// Writes the steps of a ray for each of its pixels.
void note_steps(ivec2 texel, uint steps) {
  const uint edge = kRays == kRaysOfTiles ? frame.march_scale : 1u;
  for (uint i = 0u; i < edge * edge; ++i) {
    const uvec2 px = uvec2(texel) * edge + uvec2(i % edge, i / edge);
    if (all(lessThan(px, frame.size_px))) ray_steps[px.x + frame.size_px.x * px.y] = steps;
  }
}

void main() {
  Way way;
  if (!find_ray(way)) return;
  const VolumeLayout volume = frame.volume;

  // The part of the ray inside the smoke's bounds, t in metres; it ends at the surface behind.
  const vec3 along = camera_ray(frame.camera, way.position_px, frame.size_px);
  Ray ray;
  ray.origin_world = frame.camera.eye_world;
  ray.direction = normalize(along);
  ray.jitter = blue_noise(blue_noise_tile, way.texel, frame.frame_index).r;
  ray.holes = holes_of_ray(way.position_px);
  const vec3 inverse = 1.0 / (ray.direction + vec3(equal(ray.direction, vec3(0.0))) * 1e-9);
  const vec3 low = volume.origin_world + volume.bounds_min * volume.voxel_size - ray.origin_world;
  const vec3 high = volume.origin_world + volume.bounds_max * volume.voxel_size - ray.origin_world;
  const vec3 near = min(low * inverse, high * inverse), far = max(low * inverse, high * inverse);
  const float t_begin = max(max(near.x, near.y), max(near.z, 0.0));
  const float t_last = min(min(far.x, far.y), min(far.z, way.far * length(along)));
  Gathered got = Gathered(vec3(0.0), 1.0, 0u, 0u);
  vec4 at_near = vec4(0.0, 0.0, 0.0, 1.0);
  if (t_begin < t_last) {
    if (kRays == kRaysOfTiles) {
      const float t_near = clamp(way.near * length(along), t_begin, t_last);
      march(ray, t_begin, t_near, got);
      at_near = vec4(got.radiance * frame.look.albedo, got.transmittance);
      if (got.transmittance > 0.0) march(ray, t_near, t_last, got);
    } else {
      march(ray, t_begin, t_last, got);
    }
  }
  imageStore(smoke, way.texel, vec4(got.radiance * frame.look.albedo, got.transmittance));
  if (kRays == kRaysOfTiles) imageStore(smoke_near, way.texel, at_near);
  if (kCount != kCountNothing) atomicAdd(texture_samples, got.samples);
  if (kCount == kCountSteps) note_steps(way.texel, got.steps);
}
