// The smoke on the device: a sparse volume (shared/volume.h) of several channels, and boundary cells where a surface
// runs through.
//
//   density      R: density of a free voxel (0 in a solid one), G: 1 in a free voxel, 0 in a solid one. Filtered
//                linearly, G < 1 means that the cell has a solid corner.
//   density_displacement
//                half floats, for rays from the eye (noise_advection.comp). R: density, kInSolid in
//                a solid voxel; GBA: displacement of the noise [m]. Filtered linearly, R < 0 means that the cell has a
//                solid corner.
//   filtered_density
//                half floats, for rays to lights. R: mean density of the texel after erosion,
//                kInSolid in a solid voxel; G: the fraction of the density that erosion retains
//   inscatter    half floats: radiance scattered towards the eye, per unit of albedo
//                A: 1, or 0 where light is unknown, far from smoke
//   light_side   half floats, where noise erodes the smoke (light_side.h). RGB: the direction that most light comes
//                from, as long as the fraction of the light that does; A: the optical depth that is replaced
//   fine_light   light at a finer resolution for bricks near the eye, see fine_light.h
//   cells        per slot 9^3 uints, one per cell that overlaps the brick: boundary cell + 1, or 0 where the cell has
//                no solid corner or no smoke. Cell 8 brick - 1 + (i, j, k) is entry i + 9 (j + 9 k)
//   filled       per slot the box of cells that may hold smoke, see pack_cells; rays skip the rest of the brick
//   slot_bricks  per slot the brick that it holds [bricks]
//   boundary     per boundary cell up to three planes, and the first of its 2^planes corner sets
//   corners      per set eight densities of 8 bits: those of the cell's eight corners *for a point on these sides of
//                the planes*. Corners in or behind a wall hold values extrapolated from the near side.
#ifndef BRUME_SMOKE_VOLUME_H
#define BRUME_SMOKE_VOLUME_H
#include "shared/volume.h"
SHARED_BEGIN

SHARED_BINDING(kBindPages, 1u);
SHARED_BINDING(kBindFilled, 2u);
SHARED_BINDING(kBindCells, 3u);
SHARED_BINDING(kBindBoundary, 4u);
SHARED_BINDING(kBindCorners, 5u);
SHARED_BINDING(kBindSlotBricks, 6u);
SHARED_BINDING(kBindDensity, 7u);
SHARED_BINDING(kBindDensityDisplacement, 8u);
SHARED_BINDING(kBindFilteredDensity, 9u);
SHARED_BINDING(kBindInscatter, 10u);

SHARED_CONST int kBrickCells = 9;
SHARED_CONST uint kCellsPerBrick = 729u;
/// So far below 0 that even the smallest filter weight outweighs any density.
SHARED_CONST float kInSolid = -65504.0f;

/// A box of cells of a brick in 24 bits: low corner, and one past the high corner, each coordinate in [0, 9].
SHARED_FUNCTION uint pack_cells(uvec3 low, uvec3 end) {
  return low.x | low.y << 4u | low.z << 8u | end.x << 12u | end.y << 16u | end.z << 20u;
}
SHARED_FUNCTION uvec3 cells_low(uint cells) {
  return uvec3(cells & 15u, cells >> 4u & 15u, cells >> 8u & 15u);
}
SHARED_FUNCTION uvec3 cells_end(uint cells) {
  return uvec3(cells >> 12u & 15u, cells >> 16u & 15u, cells >> 20u & 15u);
}

/// A cell that a surface runs through.
struct BoundaryCell {
  /// Planes packed by smoke::pack_plane; 0: no plane. Absent planes come last.
  uint plane0, plane1, plane2;
  /// Index of the first corner set. Set q is for points whose side of plane k is bit k of q.
  uint first_set;
};
SHARED_SIZE(BoundaryCell, 16);

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

/// Sides of the cell's planes that a point lies on: bit k is set on the positive side of plane k.
/// p_from_centre = position_voxel - (cell + 1).
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
