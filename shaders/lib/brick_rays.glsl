// Rays through the bricks of a volume, in steps that all media of a frame share.
#ifndef BRICK_RAYS_GLSL
#define BRICK_RAYS_GLSL
#include "shared/volume.h"

const uint kNoSlot = 0xffffffffu;

struct WorldRay {
  vec3 origin, direction;  // unit
};

/// A ray in the voxel space of a volume; t is in metres.
struct VoxelRay {
  vec3 origin, per_metre;
};

/// The part of a ray inside a brick, or inside the empty cube around it.
struct BrickSpan {
  vec3 low;  // low corner [voxels]
  uint slot;
  float t_first, t_stop;  // samples in [t_first, t_stop) may be inside the medium
  float t_next;           // the first sample behind the brick
};

vec3 inverse_of(VoxelRay ray) { return 1.0 / (ray.per_metre + vec3(equal(ray.per_metre, vec3(0.0))) * 1e-9); }

/// Where a ray enters and leaves a box [voxels]: x >= y where it misses.
vec2 span_in_box(VoxelRay ray, vec3 low, vec3 high) {
  const vec3 inverse = inverse_of(ray), a = (low - ray.origin) * inverse, b = (high - ray.origin) * inverse;
  const vec3 enters = min(a, b), leaves = max(a, b);
  return vec2(max(enters.x, max(enters.y, enters.z)), min(leaves.x, min(leaves.y, leaves.z)));
}

/// The brick of the sample at t.
vec3 brick_of(VoxelRay ray, float t) { return floor((ray.origin + ray.per_metre * t) / float(kBrickVoxels)); }

/// The first sample at or behind t_from, which is not before the sample at t.
float sample_from(float t_from, float t, float ds) { return t + ds * max(0.0, ceil((t_from - t) / ds - 1e-3)); }

/// From the sample at t, in a brick with a slot or in an empty cube of `empty_edge` voxels.
BrickSpan brick_span(VoxelRay ray, vec3 brick, uint slot, int empty_edge, float t, float ds) {
  BrickSpan span;
  span.slot = slot;
  const int edge = slot != kNoSlot ? kBrickVoxels : empty_edge;
  span.low = floor(brick * float(kBrickVoxels) / float(edge)) * float(edge);
  const vec3 inverse = inverse_of(ray);
  const vec3 to_low = (span.low - ray.origin) * inverse, exits = max(to_low, to_low + float(edge) * inverse);
  span.t_next = t + ds * max(1.0, ceil((min(exits.x, min(exits.y, exits.z)) - t) / ds));
  span.t_first = t;
  span.t_stop = slot == kNoSlot ? t : span.t_next - 0.5 * ds;
  return span;
}

/// Low corner of a brick's voxels in the atlas [texels].
vec3 atlas_corner(BrickLayout bricks, uint slot) { return vec3(atlas_first_texel(bricks, slot)) + 1.0; }

/// Size of a texel of the atlas in texture coordinates.
vec3 atlas_texel(BrickLayout bricks) { return 1.0 / vec3(bricks.atlas_bricks * kBrickTexels); }

/// Narrows a span to a box of its brick [voxels from its low corner].
void narrow_to(vec3 low, vec3 end, VoxelRay ray, float t, float ds, inout BrickSpan span) {
  const vec3 inverse = inverse_of(ray), to_low = (span.low - ray.origin) * inverse;
  const vec3 to_first = to_low + low * inverse, to_end = to_low + end * inverse;
  const vec3 enters = min(to_first, to_end), leaves = max(to_first, to_end);
  span.t_first = sample_from(max(enters.x, max(enters.y, enters.z)), t, ds);
  span.t_stop = min(min(leaves.x, min(leaves.y, leaves.z)) + 1e-3 * ds, span.t_stop);
}

#endif
