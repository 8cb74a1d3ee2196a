// Texels of the smoke's bricks, one by one. Needs `frame`; the includer has `slot_bricks`.
#ifndef SMOKE_TEXELS_GLSL
#define SMOKE_TEXELS_GLSL

ivec3 local_texel(uint local) { return ivec3(local % 10u, local / 10u % 10u, local / 100u); }

/// Where a texel of a brick lies in the atlas.
ivec3 texel_in_atlas(uint slot, uint local) {
  const uvec3 bricks = uvec3(frame.volume.atlas_bricks);
  const uvec3 corner = uvec3(slot % bricks.x, slot / bricks.x % bricks.y, slot / (bricks.x * bricks.y)) * uint(kBrickTexels);
  return ivec3(corner) + local_texel(local);
}

/// Where it lies in voxel space.
vec3 texel_position(uint slot, uint local) { return vec3(slot_bricks[slot] * kBrickVoxels + local_texel(local)) - 0.5; }

vec3 world_from_voxel(vec3 position_voxel) { return frame.volume.origin_world + position_voxel * frame.volume.voxel_size; }

#endif
