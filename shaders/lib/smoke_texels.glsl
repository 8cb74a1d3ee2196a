// Texels of the smoke's bricks, one by one. Needs `frame`; the includer has `slot_bricks`.
#ifndef SMOKE_TEXELS_GLSL
#define SMOKE_TEXELS_GLSL

struct SmokeTexel {
  ivec3 at;  // in the atlas
  vec3 position_voxel;
};

/// The texel of a number of the list (shared/smoke_light.h).
SmokeTexel smoke_texel(uint number) {
  const uint slot = number / kTexelsPerBrick, i = number % kTexelsPerBrick;
  const ivec3 local = ivec3(i % 10u, i / 10u % 10u, i / 100u);
  const uvec3 bricks = uvec3(frame.volume.atlas_bricks);
  const uvec3 corner = uvec3(slot % bricks.x, slot / bricks.x % bricks.y, slot / (bricks.x * bricks.y)) * uint(kBrickTexels);
  return SmokeTexel(ivec3(corner) + local, vec3(slot_bricks[slot] * kBrickVoxels + local) - 0.5);
}

vec3 world_from_voxel(vec3 position_voxel) { return frame.volume.origin_world + position_voxel * frame.volume.voxel_size; }

#endif
