// Sparse volumes on the device: page tables, bricks in an atlas, and placement.
//
//   pages   of each volume a page table of two levels. Root: one uint per node of a window, x + size.x (y + size.y z)
//           of node - window_origin: node + kFirstNode, or how far the nearest node is. Behind it the nodes, 8^3 uints,
//           one per brick of 8^3 voxels, x + 8 (y + 8 z) of brick - 8 node: slot + 1; 0 where it is empty; or
//           kUniformBrick and a half float, where all texels of its only channel are that one
//   atlas   per channel a 3D texture of 10^3-texel bricks: 8^3 voxels and an apron of one texel
//
// Voxel space is measured in voxels: voxel (i, j, k) covers [i, i + 1) x [j, j + 1) x [k, k + 1).
#ifndef BRUME_VOLUME_H
#define BRUME_VOLUME_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindVolumes, 27u);
SHARED_BINDING(kBindVolumePages, 28u);
SHARED_BINDING(kBindVolumeValues, 29u);
SHARED_BINDING(kBindVolumeLight, 30u);
SHARED_BINDING(kBindVolumeColors, 31u);
SHARED_BINDING(kBindTransfers, 53u);
SHARED_BINDING(kBindColorGrids, 54u);
SHARED_BINDING(kBindVolumeEffects, 60u);
SHARED_BINDING(kBindMaskPairs, 64u);

SHARED_CONST int kBrickVoxels = 8;
SHARED_CONST int kBrickTexels = 10;
SHARED_CONST int kNodeBricks = 8;
SHARED_CONST uint kPageEntries = 512u;
/// Entries of the root below it are empty: in the cube of the nodes that are fewer nodes away along each axis there is
/// none. 0 says as little as 1.
SHARED_CONST uint kFirstNode = 256u;
SHARED_CONST uint kUniformBrick = 0x80000000u;
SHARED_CONST uint kTexelsPerBrick = 1000u;
/// Optical depth of a voxel above which a volume is dense.
SHARED_CONST float kDenseVoxelDepth = 1.5f;
/// The most volumes of a frame besides the smoke.
SHARED_CONST uint kMaxVolumes = 32u;

/// Where a volume is in the page buffer and in the images of its atlas.
/// What is derived is stored, too: a constant costs a GPU nothing, but what it computes from one takes a register.
struct BrickLayout {
  ivec3 window_origin;  // first node of the page table, in nodes of kNodeBricks^3 bricks
  uint first_page;      // of the root, in the page buffer
  ivec3 window_size;    // nodes
  uint first_slot;      // of the atlas; slots of the page table count from here
  ivec3 atlas_bricks;   // bricks per axis of the atlas, powers of two along x and y
  uint atlas_bits_x;    // logarithms of atlas_bricks.xy
  vec3 atlas_texel;     // size of a texel in texture coordinates
  uint atlas_bits_y;
};
SHARED_SIZE(BrickLayout, 64);

/// Placement of a volume whose axes are those of the world.
struct VolumeLayout {
  vec3 origin_world;  // low corner of voxel (0, 0, 0) [m]
  float voxel_size;   // [m]
  vec3 texels_per_metre;  // in texture coordinates of the atlas
  float voxels_per_metre;
  vec3 bounds_min;        // where density can be above 0 [voxel space]
  float padding SHARED_ZERO;
  vec3 bounds_max;
  float padding_1 SHARED_ZERO;
  BrickLayout bricks;
};
SHARED_SIZE(VolumeLayout, 128);

/// Absorption and scattering of a volume where its density is 1.
struct VolumeLook {
  vec3 albedo;                 // single-scattering albedo, [0, 1]
  float extinction;            // [1/m], >= 0
  vec3 emission;               // radiance that an opaque part of the volume emits
  float anisotropy;            // Henyey-Greenstein g, (-1, 1)
  float multiple_scattering;   // weight of light scattered more than once; 0: single scattering only
  vec3 padding SHARED_ZERO;
};
SHARED_SIZE(VolumeLook, 48);

/// Colours of a row, from a value of 0 to that at the end of the row.
SHARED_CONST uint kVolumeColors = 256u;

/// Kinds of transfer functions.
SHARED_CONST uint kTransferNone = 0u;
SHARED_CONST uint kTransferColors = 1u;   // colours by value; the value is the density
SHARED_CONST uint kTransferOpacity = 2u;  // colours and densities by value
/// Cells that a table divides its range of values into.
SHARED_CONST uint kTransferCells = 1024u;
/// Entries of a table, each a vec4 of colour times opacity, and opacity: the curve at the low end of the range, its
/// integrals from there to each border of the cells in units of the range, the curve at the high end.
SHARED_CONST uint kTransferEntries = 1027u;
/// Beyond this many ranges below or above the range, values count as there.
SHARED_CONST float kTransferReach = 64.0f;

/// The transfer function of a volume: a value v is at the position v per_value + first of its table, whose range is
/// [0, 1].
struct VolumeTransfer {
  float first, per_value;
  float scattered;  // fraction of the colour that is the albedo
  float emitted;    // radiance of an opaque part per colour
};
SHARED_SIZE(VolumeTransfer, 16);

/// What the colours of a volume are.
SHARED_CONST uint kColorsNone = 0u;
SHARED_CONST uint kColorsAlbedo = 1u;  // factors of its albedo
SHARED_CONST uint kColorsMasks = 2u;   // three or four masks that glow
SHARED_CONST uint kColorsPair = 3u;    // one or two, in an atlas of half as many bytes a texel

/// Noise below the voxels of a volume, which wears away what is thin (shared/volume_detail.h).
struct VolumeDetail {
  float strength;         // as SmokeLook::erosion; 0: none
  float per_value;        // of a value, to a density that is 1 where the volume is densest
  float tiles_per_metre;  // of the noise, along the axis of most
  float padding SHARED_ZERO;
};
SHARED_SIZE(VolumeDetail, 16);

/// A volume of one channel, its density >= 0, under any affine transform. It may have a second grid, which glows: where
/// its value is h, as much light leaves a metre as look.extinction times the colour at h in the volume's row of the
/// colours; and colours or masks in bricks of the same slots as its own.
struct VolumeInstance {
  Affine voxel_from_world;  // [voxels/m]
  Affine world_from_voxel;
  vec3 bounds_min;          // where density can be above 0 [voxel space]
  uint is_dense;            // 1: opaque within a voxel or two, like a surface; else 0
  vec3 bounds_max;
  uint number;              // in the frame's list of volumes, in view or not
  float heat_per_value;     // position in the row of a value of 1; 0: the volume has no heat
  uint color_kind;          // kColors...
  uint transfer_kind;       // kTransfer...
  uint padding SHARED_ZERO;
  VolumeLook look;
  BrickLayout bricks;
  Affine heat_from_world;  // to the voxel space of the second grid
  BrickLayout heat_bricks;
  Affine sun_from_voxel;  // to the cube of the sun's depths, [0, 1]^3 (volume_light.h)
  VolumeTransfer transfer;
  BrickLayout color_bricks;
  VolumeDetail detail;
};
SHARED_SIZE(VolumeInstance, 512);

/// Whether a volume can glow.
SHARED_FUNCTION bool glows(VolumeInstance volume) {
  vec3 emission = volume.look.emission;
  bool by_transfer = volume.transfer_kind != kTransferNone && volume.transfer.emitted > 0.0f;
  return volume.heat_per_value > 0.0f || volume.color_kind >= kColorsMasks || by_transfer ||
         max(emission.r, max(emission.g, emission.b)) > 0.0f;
}

/// What few volumes have: tints of their masks, noise that moves the places at which they are sampled, and the place of
/// their detail's.
struct VolumeEffect {
  Affine tints;           // a column per mask: radiance per metre where it is 1
  vec4 growth;            // factor of the displacement at p: dot(xyz, p_voxel) + w, limited to [0, 1]
  vec3 tiles_per_voxel;   // of the noise
  float padding SHARED_ZERO;
  vec3 tile_offset;
  float padding_1 SHARED_ZERO;
  vec3 amplitude;         // largest displacement [voxels]; 0: none
  float padding_2 SHARED_ZERO;
  vec3 detail_per_voxel;  // tiles of the detail's noise
  float padding_3 SHARED_ZERO;
  vec3 detail_offset;
  float padding_4 SHARED_ZERO;
};
SHARED_SIZE(VolumeEffect, 144);

/// Entry of the root for a brick, in the page buffer; kNoPage outside of the window.
SHARED_CONST uint kNoPage = 0xffffffffu;
SHARED_FUNCTION uint root_page(BrickLayout bricks, ivec3 brick) {
  ivec3 n = (brick >> 3) - bricks.window_origin, size = bricks.window_size;
  bool outside = n.x < 0 || n.y < 0 || n.z < 0 || n.x >= size.x || n.y >= size.y || n.z >= size.z;
  return outside ? kNoPage : bricks.first_page + uint(n.x + size.x * (n.y + size.y * n.z));
}

/// Entry for a brick in the node that its root entry names.
SHARED_FUNCTION uint node_page(BrickLayout bricks, uint root, ivec3 brick) {
  ivec3 size = bricks.window_size, b = brick & (kNodeBricks - 1);
  uint first = uint(size.x * size.y * size.z) + (root - kFirstNode) * kPageEntries;
  return bricks.first_page + first + uint(b.x + kNodeBricks * (b.y + kNodeBricks * b.z));
}

/// Position of a slot in an atlas [bricks]: slot = x + size.x (y + size.y z). By shifts: a GPU takes some 20
/// instructions to divide by a number that is no power of two.
SHARED_FUNCTION uvec3 atlas_brick(BrickLayout bricks, uint slot) {
  uvec2 bits = uvec2(bricks.atlas_bits_x, bricks.atlas_bits_y);
  uint row = slot >> bits.x;
  return uvec3(slot - (row << bits.x), row & ((1u << bits.y) - 1u), row >> bits.y);
}

/// First texel of a slot's brick in the atlas: the low corner of its apron.
SHARED_FUNCTION uvec3 atlas_first_texel(BrickLayout bricks, uint slot) {
  return atlas_brick(bricks, bricks.first_slot + slot) * uint(kBrickTexels);
}

SHARED_END
#endif
