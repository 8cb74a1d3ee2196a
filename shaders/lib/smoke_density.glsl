// Density of the smoke at a point: bricks by the texture unit, boundary cells by their planes.
#ifndef SMOKE_DENSITY_GLSL
#define SMOKE_DENSITY_GLSL
#include "lib/boundary_cells.glsl"
#include "lib/bricks.glsl"

layout(binding = kBindDensity) uniform sampler3D density_atlas;

/// Smoke at a point of a slot's brick. local_voxel: the point relative to the brick's low corner; uvw: its position in
/// the atlas.
BrickSample sample_brick(uint slot, vec3 local_voxel, vec3 uvw) {
  const vec2 texel = textureLod(density_atlas, uvw, 0.0).rg;
  BrickSample here = BrickSample(texel.r, vec3(0.0));
  if (texel.g < 1.0 - 1.0 / 512.0) {
    here = boundary_sample(slot, local_voxel);
    if (here.density == kNoBoundary) here.density = texel.r;
  }
  return here;
}

/// Smoke at a single point.
struct SmokePoint {
  float density;  // [0, 1]
  uint slot;      // kNoSlot: no smoke in the brick
  vec3 local_voxel;
};

SmokePoint smoke_at(VolumeLayout volume, vec3 p_voxel) {
  const ivec3 brick = ivec3(floor(p_voxel / float(kBrickVoxels)));
  int empty_edge;
  SmokePoint point;
  point.slot = slot_at(volume.bricks, brick, empty_edge);
  point.local_voxel = p_voxel - vec3(brick * kBrickVoxels);
  point.density = 0.0;
  if (point.slot != kNoSlot) {
    const vec3 uvw = (atlas_corner(volume.bricks, point.slot) + point.local_voxel) * volume.bricks.atlas_texel;
    point.density = sample_brick(point.slot, point.local_voxel, uvw).density;
  }
  return point;
}

#endif
