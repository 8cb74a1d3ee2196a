// Texels of the smoke's bricks, apron included, x + 10 (y + 10 z).
#ifndef SMOKE_TEXELS_GLSL
#define SMOKE_TEXELS_GLSL
#include "lib/frame.glsl"

layout(scalar, binding = kBindSlotBricks) readonly buffer SlotBricks { PackedIvec3 slot_bricks[]; };

ivec3 local_texel(uint local) { return ivec3(local % 10u, local / 10u % 10u, local / 100u); }

/// Position of a texel of a brick in the atlas.
ivec3 texel_in_atlas(uint slot, uint local) {
  return ivec3(atlas_first_texel(frame.smoke.bricks, slot)) + local_texel(local);
}

/// Its centre in voxel space.
vec3 texel_position(uint slot, uint local) {
  return vec3(unpacked(slot_bricks[slot]) * kBrickVoxels + local_texel(local)) - 0.5;
}

vec3 world_from_voxel(vec3 p_voxel) { return frame.smoke.origin_world + p_voxel * frame.smoke.voxel_size; }

#endif
