// Rays through the bricks of a volume, in steps that all media of a frame share.
#ifndef BRICK_RAYS_GLSL
#define BRICK_RAYS_GLSL
#include "shared/volume.h"

const uint kNoSlot = 0xffffffffu;
/// Of a brick whose texels are all alike, and not stored.
const uint kUniformSlot = 0xfffffffeu;

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
  float uniform_value;
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

/// What a page table knows of a point: its brick, or an empty cube around it.
struct BrickAt {
  vec3 low;             // low corner [voxels]
  float edge;           // [voxels]
  uint slot;            // kNoSlot: the medium is nowhere in the cube; kUniformSlot
  float uniform_value;  // that of all texels of a uniform brick
};

/// The empty cube around a brick, from its entry in the root.
BrickAt empty_nodes(ivec3 brick, uint distance) {
  const int reach = max(int(distance), 1) - 1, edge = kNodeBricks * kBrickVoxels;
  return BrickAt(vec3(((brick >> 3) - reach) * edge), float((2 * reach + 1) * edge), kNoSlot, 0.0);
}

/// Low corner of a brick's voxels in the atlas [texels].
vec3 atlas_corner(BrickLayout bricks, uint slot) { return vec3(atlas_first_texel(bricks, slot)) + 1.0; }

/// The first sample at or behind t_from, which is not before the sample at t.
float sample_from(float t_from, float t, float ds) { return t + ds * max(0.0, ceil((t_from - t) / ds - 1e-3)); }

/// From the sample at t, which is in the brick. `inverse` is that of the ray.
BrickSpan brick_span(VoxelRay ray, vec3 inverse, BrickAt at, float t, float ds) {
  BrickSpan span;
  span.slot = at.slot;
  span.low = at.low;
  span.uniform_value = at.uniform_value;
  const vec3 to_low = (span.low - ray.origin) * inverse, exits = max(to_low, to_low + at.edge * inverse);
  span.t_next = t + ds * max(1.0, ceil((min(exits.x, min(exits.y, exits.z)) - t) / ds));
  span.t_first = t;
  span.t_stop = at.slot == kNoSlot ? t : span.t_next - 0.5 * ds;
  return span;
}

/// Narrows a span to a box of its brick [voxels from its low corner].
void narrow_to(vec3 low, vec3 end, VoxelRay ray, float t, float ds, inout BrickSpan span) {
  const vec3 inverse = inverse_of(ray), to_low = (span.low - ray.origin) * inverse;
  const vec3 to_first = to_low + low * inverse, to_end = to_low + end * inverse;
  const vec3 enters = min(to_first, to_end), leaves = max(to_first, to_end);
  span.t_first = sample_from(max(enters.x, max(enters.y, enters.z)), t, ds);
  span.t_stop = min(min(leaves.x, min(leaves.y, leaves.z)) + 1e-3 * ds, span.t_stop);
}

#endif
