// Volumes besides the smoke as a medium of lib/media.glsl: bricks of densities under any affine transform, lit by the
// ambient light and by themselves.
#ifndef MEDIUM_VOLUMES_GLSL
#define MEDIUM_VOLUMES_GLSL
#include "lib/brick_rays.glsl"
#include "lib/frame.glsl"

layout(scalar, binding = kBindVolumes) readonly buffer Volumes { VolumeInstance volumes[]; };
layout(scalar, binding = kBindVolumePages) readonly buffer VolumePages { uint volume_pages[]; };
layout(binding = kBindVolumeDensity) uniform sampler3D volume_density_atlas;

/// As slot_at of the smoke.
uint volume_slot_at(BrickLayout bricks, ivec3 brick, out int empty_edge) {
  empty_edge = kBrickVoxels * kNodeBricks;
  const uint root = root_page(bricks, brick);
  const uint node = root == kNoPage ? 0u : volume_pages[root];
  if (node == 0u) return kNoSlot;
  empty_edge = kBrickVoxels;
  return volume_pages[node_page(bricks, node, brick)] - 1u;
}

struct VolumesSpan {
  uint present;  // bit i: samples in [t_first, t_stop) may be inside volume i
  float t_first, t_stop, t_next;
};

/// The span of one volume: a brick, an empty cube, or all samples before or behind its bounds.
BrickSpan volume_span(uint i, WorldRay world, float t, float ds) {
  const VoxelRay ray = VoxelRay(volumes[i].voxel_from_world * vec4(world.origin, 1.0),
                                volumes[i].voxel_from_world * vec4(world.direction, 0.0));
  const vec3 inverse = inverse_of(ray);
  const vec3 a = (volumes[i].bounds_min - ray.origin) * inverse, b = (volumes[i].bounds_max - ray.origin) * inverse;
  const vec3 enters = min(a, b), leaves = max(a, b);
  const float enter = max(enters.x, max(enters.y, enters.z)), leave = min(leaves.x, min(leaves.y, leaves.z));
  if (enter >= leave || t >= leave) return BrickSpan(vec3(0.0), kNoSlot, t, t, 1e30);
  const float t_inside = sample_from(enter, t, ds);
  if (t_inside > t) return BrickSpan(vec3(0.0), kNoSlot, t, t, t_inside);
  const vec3 brick = brick_of(ray, t);
  int empty_edge;
  const uint slot = volume_slot_at(volumes[i].bricks, ivec3(brick), empty_edge);
  return brick_span(ray, brick, slot, empty_edge, t, ds);
}

VolumesSpan volumes_span(WorldRay ray, float t, float ds) {
  VolumesSpan span = VolumesSpan(0u, t, t, 1e30);
  for (uint i = 0u; i < frame.media.volume_count; ++i) {
    const BrickSpan bricks = volume_span(i, ray, t, ds);
    span.t_next = min(span.t_next, bricks.t_next);
    if (bricks.slot != kNoSlot) span.present |= 1u << i;
  }
  if (span.present != 0u) span.t_stop = span.t_next - 0.5 * ds;
  return span;
}

/// Sums over the volumes.
struct VolumesSample {
  float extinction;  // [1/m]
  vec3 light;        // extinction times radiance towards the eye
};

VolumesSample sample_volumes(VolumesSpan span, vec3 p_world, inout uint texture_samples) {
  VolumesSample sum = VolumesSample(0.0, vec3(0.0));
  for (uint left = span.present; left != 0u; left &= left - 1u) {
    const uint i = uint(findLSB(left));
    const BrickLayout bricks = volumes[i].bricks;
    const vec3 p_voxel = volumes[i].voxel_from_world * vec4(p_world, 1.0);
    const vec3 brick = floor(p_voxel / float(kBrickVoxels));
    int empty_edge;
    const uint slot = volume_slot_at(bricks, ivec3(brick), empty_edge);
    if (slot == kNoSlot) continue;
    const vec3 uvw = (atlas_corner(bricks, slot) + p_voxel - brick * float(kBrickVoxels)) * atlas_texel(bricks);
    const VolumeLook look = volumes[i].look;
    const float extinction = look.extinction * textureLod(volume_density_atlas, uvw, 0.0).r;
    sum.extinction += extinction;
    sum.light += extinction * (look.albedo * frame.sky.ambient + look.emission);
    ++texture_samples;
  }
  return sum;
}

#endif
