// Ambient occlusion around a mesh: how much of the sky it hides from points in a box, on planes that face up
// and on planes that face down.
#pragma once

#include <atomic>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "core/box.hpp"
#include "core/error.hpp"
#include "grids/dense_grid.hpp"
#include "voxel/triangle.hpp"

namespace brume::bake {

struct OcclusionOptions {
  glm::uvec3 size{64};  ///< Voxels along x, y and z, each at least 1; a slice across y is a plane of texels.
  Box<double> box;      ///< Around the mesh [m]: low < high along each axis, finite.
  std::uint32_t rays = 256;  ///< Per texel and direction, 1 to 2^24. Powers of two are best.
  std::uint32_t seed = 0;
};

/// The fraction of a cosine-weighted hemisphere that the mesh hides from the middle of each voxel, [0, 1], at
/// whatever distance. Planes hide nothing from each other.
struct Occlusion {
  grids::DenseGrid up;    ///< Around +y: from points on ground that faces up.
  grids::DenseGrid down;  ///< Around -y.
};

/// Traces the rays of all texels, on all threads: Owen-scrambled points of Sobol (Burley 2020, "Practical
/// Hash-based Owen Scrambling"), mapped to the disk below the hemisphere (Shirley and Chiu 1997, "A Low
/// Distortion Map Between Disk and Square"). 256 rays are off by 0.005 to 0.007 (RMS) beside a mesh of large
/// faces, and a power of two of them by at most 0.71 / sqrt(rays) beside any (Owen 1997, "Monte Carlo
/// Variance of Scrambled Net Quadrature"). The errors of neighbours have nothing in common.
///
/// Triangles hide from both sides, and no ray passes between triangles that have an edge in common. Rays
/// start slightly off the texel, so that one exactly on a triangle has the value of a point beside it, and
/// its neighbours on the same plane the value of the same side: above it for `up` and below it for `down`, up
/// to a slope of 70 degrees; where a wall is steeper, that along +x and +z. The offset is at most a
/// thousandth of a voxel's shortest edge, or 1/200,000 of the box's longest, if that is more.
///
/// The triangles may reach beyond the box. Those with a corner that is not finite, or 10^11 times the box's
/// longest edge away, hide nothing. The same numbers for any number of threads; other processors may round
/// differently. Fails with resource_limit where there are more than 2^32 texels or 10^9 triangles or when
/// memory runs out, and with internal soon once `stopped` (null: never) is true: within about 0.1 s, and 0.1
/// s more for each million triangles.
Result<Occlusion> bake_occlusion(std::span<const voxel::Triangle> triangles, const OcclusionOptions& options,
                                 const std::atomic<bool>* stopped = nullptr);

/// How up and down become one grid (combine_occlusion).
struct OcclusionCurve {
  double gamma = 1;       ///< Exponent at the middle slice, > 0: below 1 darkens.
  double correction = 1;  ///< How much of the gamma applies at the middle slice, [0, 1].
  double falloff = 1;     ///< How fast that fades towards the first and the last slice, >= 0; 0: not at all.
};

/// The larger of both at each voxel, raised to the power 1 + (gamma - 1) correction (1 - d)^falloff, where d
/// is the distance of the slice's middle from the middle of the box, 1 at the box's ends. Both grids have the
/// same size and box.
grids::DenseGrid combine_occlusion(const Occlusion& occlusion, const OcclusionCurve& curve);

}  // namespace brume::bake
