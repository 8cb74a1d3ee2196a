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
  glm::uvec3 size{64};       ///< Voxels along x, y and z; each slice across y is a plane of texels.
  Box<double> box;           ///< Around the mesh [m].
  std::uint32_t rays = 256;  ///< Per texel and direction, at least 1.
  std::uint32_t seed = 0;
};

/// The fraction of a cosine-weighted hemisphere that the mesh hides from the middle of each voxel, [0, 1].
/// Planes hide nothing from each other.
struct Occlusion {
  grids::DenseGrid up;    ///< Around +y: from points on ground that faces up.
  grids::DenseGrid down;  ///< Around -y.
};

/// Traces the rays of all texels, on all threads. Triangles hide from both sides. The same numbers for any
/// number of threads. Fails with resource_limit when memory runs out, and soon once `stopped` (null: never)
/// is true.
Result<Occlusion> bake_occlusion(std::span<const voxel::Triangle> triangles, const OcclusionOptions& options,
                                 const std::atomic<bool>* stopped = nullptr);

/// How up and down become one grid (combine_occlusion).
struct OcclusionCurve {
  double gamma = 1;       ///< Exponent at the middle slice, > 0: below 1 darkens.
  double correction = 1;  ///< How much of the gamma applies at the middle slice, [0, 1].
  double falloff = 1;     ///< How fast that fades towards the first and the last slice, >= 0; 0: not at all.
};

/// The larger of both at each voxel, raised to the power 1 + (gamma - 1) correction (1 - d)^falloff, where d
/// is the slice's distance from the middle of the box, 1 at its ends.
grids::DenseGrid combine_occlusion(const Occlusion& occlusion, const OcclusionCurve& curve);

}  // namespace brume::bake
