// Density of the smoke at a point: bricks by the texture unit, boundary cells by their planes.
// The includer defines BINDING_DENSITY and the bindings of lib/smoke_bricks.glsl.
#ifndef SMOKE_DENSITY_GLSL
#define SMOKE_DENSITY_GLSL
#include "lib/smoke_bricks.glsl"

layout(binding = BINDING_DENSITY) uniform sampler3D density_atlas;

/// What is at a point of a brick that has a slot; local_voxel: the point less the brick's low corner, uvw: where it lies
/// in the atlas.
SmokeSample sample_brick(uint slot, vec3 local_voxel, vec3 uvw) {
  const vec2 texel = textureLod(density_atlas, uvw, 0.0).rg;
  SmokeSample here = SmokeSample(texel.r, vec3(0.0));
  if (texel.g < 1.0 - 1.0 / 512.0) { here = boundary_sample(slot, local_voxel); }
  return here;
}

/// A point of the smoke, for those who ask one at a time.
struct SmokePoint {
  float density;  // [0, 1]
  uint slot;      // kNoSlot: no smoke anywhere near
  vec3 local_voxel;
};

SmokePoint smoke_at(VolumeLayout volume, vec3 p_voxel) {
  const ivec3 brick = ivec3(floor(p_voxel / float(kBrickVoxels)));
  int empty_edge;
  SmokePoint point;
  point.slot = slot_at(volume, brick, empty_edge);
  point.local_voxel = p_voxel - vec3(brick * kBrickVoxels);
  point.density = 0.0;
  if (point.slot != kNoSlot) {
    const vec3 uvw = (atlas_corner(volume, point.slot) + point.local_voxel) * atlas_texel(volume);
    point.density = sample_brick(point.slot, point.local_voxel, uvw).density;
  }
  return point;
}

#endif
