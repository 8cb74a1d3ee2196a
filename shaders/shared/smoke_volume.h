// Smoke density as the march reads it: sparse bricks, and boundary cells where a surface runs through.
//
//   pages        a table of two levels: the root, one uint per node of a window of the world, node + 1 or 0
//                where there is no smoke, x + size.x (y + size.y z) of node - window_origin; after it the
//                nodes, 8^3 uints each, slot + 1 or 0 per 8^3-voxel brick: x + 8 (y + 8 z) of brick - 8 node
//   density      a 3D texture of 10^3-texel bricks (8^3 voxels and an apron of one texel); R: density of a
//                free voxel (0 in a solid one), G: 1 in a free voxel, 0 in a solid one. Trilinear: G < 1 says
//                that the cell has a solid corner.
//   medium       half floats of the same layout, what the eye's rays read (shaders/drift.comp); R: density, kInSolid in a
//                solid voxel, GBA: how far the noise was carried [m]. Trilinear: R < 0 says that the cell has a solid corner.
//   share        half floats of the same layout, what rays of light read; R: density that the noise leaves in the mean of the
//                texel, kInSolid in a solid voxel; G: the share of the density that it leaves there
//   cells        per slot 9^3 uints, one per cell whose points can lie in the brick: boundary cell + 1, or 0
//                where the cell has no solid corner or no smoke. Cell 8 brick - 1 + (i, j, k) is entry i + 9 (j + 9 k)
//   filled       per slot the cells in which smoke may be, as pack_cells packs them: rays leave out the rest of the brick
//   boundary     per boundary cell up to three planes, and the first of its 2^planes corner sets
//   corners      per set eight densities of 8 bits: what the cell's eight corners hold *for a point on those
//                sides of the planes*. Corners in or behind a wall carry what the near side extrapolates to.
#ifndef BRUME_SMOKE_VOLUME_H
#define BRUME_SMOKE_VOLUME_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_CONST int kBrickVoxels = 8;
SHARED_CONST int kBrickTexels = 10;
SHARED_CONST int kBrickCells = 9;
SHARED_CONST int kNodeBricks = 8;
SHARED_CONST uint kPageEntries = 512u;
SHARED_CONST uint kCellsPerBrick = 729u;
SHARED_CONST uint kTexelsPerBrick = 1000u;
/// So far below 0 that the least share of it outweighs any density.
SHARED_CONST float kInSolid = -16384.0f;

/// A box of cells of a brick in 24 bits: its low corner, and one past its high one, each number in [0, 9].
SHARED_FUNCTION uint pack_cells(uvec3 low, uvec3 end) {
  return low.x | low.y << 4u | low.z << 8u | end.x << 12u | end.y << 16u | end.z << 20u;
}
SHARED_FUNCTION uvec3 cells_low(uint cells) {
  return uvec3(cells & 15u, cells >> 4u & 15u, cells >> 8u & 15u);
}
SHARED_FUNCTION uvec3 cells_end(uint cells) {
  return uvec3(cells >> 12u & 15u, cells >> 16u & 15u, cells >> 20u & 15u);
}

/// One cell that a surface runs through.
struct BoundaryCell {
  /// Planes as pack_plane makes them; 0 where there is none. Empty ones come last.
  uint plane0, plane1, plane2;
  /// Index of the first corner set. Set q is for points whose side of plane k is bit k of q.
  uint first_set;
};
SHARED_SIZE(BoundaryCell, 16);

/// Where the window and the bricks lie.
struct VolumeLayout {
  vec3 origin_world;    // low corner of voxel (0, 0, 0) [m]
  float voxel_size;     // [m]
  ivec3 window_origin;  // first node of the page table, in nodes of kNodeBricks^3 bricks
  ivec3 window_size;    // nodes
  ivec3 atlas_bricks;   // bricks per axis of the density texture; slot = x + bx * (y + by * z)
  vec3 bounds_min;      // where density can be above 0 [voxel space]
  vec3 bounds_max;
};
SHARED_SIZE(VolumeLayout, 76);

/// Plane in 32 bits: octahedral normal 2 x 10 bits, offset 12 bits over [-1, 1]. Never 0.
/// Octahedral map: Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit Vectors".
SHARED_FUNCTION vec3 plane_normal(uint plane) {
  vec2 e = vec2(float(plane & 1023u), float((plane >> 10) & 1023u)) * (2.0f / 1022.0f) - vec2(1.0f);
  vec3 n = vec3(e.x, e.y, 1.0f - abs(e.x) - abs(e.y));
  float t = max(-n.z, 0.0f);
  n.x += n.x >= 0.0f ? -t : t;
  n.y += n.y >= 0.0f ? -t : t;
  return normalize(n);
}

/// Offset of the plane from the centre of its cell along the normal [voxels].
SHARED_FUNCTION float plane_offset(uint plane) {
  return float(plane >> 20) * (2.0f / 4094.0f) - 1.0f;
}

/// On which sides of the planes of its cell a point lies: bit k is set when it is on the positive side of
/// plane k. p_from_centre = position_voxel - (cell + 1).
SHARED_FUNCTION uint boundary_side(BoundaryCell cell, vec3 p_from_centre) {
  uint side = 0u;
  if (cell.plane0 != 0u && dot(plane_normal(cell.plane0), p_from_centre) > plane_offset(cell.plane0))
    side |= 1u;
  if (cell.plane1 != 0u && dot(plane_normal(cell.plane1), p_from_centre) > plane_offset(cell.plane1))
    side |= 2u;
  if (cell.plane2 != 0u && dot(plane_normal(cell.plane2), p_from_centre) > plane_offset(cell.plane2))
    side |= 4u;
  return side;
}

/// Density in [0, 1] at f in [0, 1]^3 between the cell's corners: f = position_voxel - 0.5 - cell. Corner j
/// is voxel cell + (j & 1, j >> 1 & 1, j >> 2), bits 8 j to 8 j + 7 of the set; corners 0 to 3 are in x.
SHARED_FUNCTION float corner_set_density(uvec2 corner_set, vec3 f) {
  vec4 low = unpackUnorm4x8(corner_set.x);
  vec4 high = unpackUnorm4x8(corner_set.y);
  vec4 layer = mix(low, high, f.z);
  vec2 row = mix(vec2(layer.x, layer.y), vec2(layer.z, layer.w), f.y);
  return mix(row.x, row.y, f.x);
}

SHARED_END
#endif
