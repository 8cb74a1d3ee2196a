// Light that a volume under one sun scatters once towards an eye, in double precision: what the pictures of
// renderers are compared with (script/bench-peers). It shares no code with the renderer.
//
// Densities are interpolated trilinearly between the samples of a grid, which lie at the integers of its
// index space as OpenVDB's and NanoVDB's do, and are 0 elsewhere.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "core/error.hpp"
#include "grids/grid.hpp"

namespace brume::peers {

/// A grid's values as an array of floats with a border of zeros.
class DenseField {
 public:
  /// Fails with bad_input for a grid that is not of float32, has tiles or a background other than 0, or an
  /// axis without length; with resource_limit for more than 2^31 voxels around the active ones.
  static Result<DenseField> from(const grids::Grid& grid);

  /// Cells between samples, in local space: index space moved so that the first cell is at 0. At least 1 per
  /// axis.
  glm::ivec3 cells() const { return samples_ - 1; }
  /// The density at a point of a cell, [0, 1]^3 within it.
  double in_cell(glm::ivec3 cell, const glm::dvec3& at) const;
  /// The density at a point in local space; 0 outside.
  double at(const glm::dvec3& p_local) const;
  const glm::dmat4& local_from_world() const { return local_from_world_; }

 private:
  glm::ivec3 samples_{0};
  std::vector<float> values_;  // x fastest
  glm::dmat4 local_from_world_{1};
};

/// In a world of metres. Radiance is that of a volume of albedo 1 under a sun whose light, scattered evenly
/// in all directions, has a radiance of 1: irradiance / (4 pi).
struct SingleScattering {
  glm::dvec3 eye{0}, target{0, 0, -1};  ///< +y is up in the image; the view must not be along it.
  double fov = 1;                       ///< Vertical field of view [radians], (0, pi).
  std::uint32_t width = 1, height = 1;  ///< A ray through the middle of each pixel.
  glm::dvec3 to_sun{0, 1, 0};           ///< Unit.
  double extinction = 1;                ///< Where the density is 1 [1/m], >= 0.
};

/// One value per pixel, rows from the top.
using Radiances = std::vector<float>;

/// Optical depths are exact: along a ray, a trilinear density is a cubic in each cell, which two Gauss points
/// integrate. What is scattered is integrated by `points` Gauss points per cell, 1 to 4 (Abramowitz and
/// Stegun 1964, 25.4.30). Rays end at a transmittance below 1e-7. On all cores.
Radiances integrate_cells(const DenseField& field, const SingleScattering& scene, int points);

/// The same integral by equal steps of at most `step_m` metres along the eye's ray and from each of its
/// samples along a ray to the sun, each sampled in its middle: slow and plain, to check the above.
Radiances integrate_steps(const DenseField& field, const SingleScattering& scene, double step_m);

}  // namespace brume::peers
