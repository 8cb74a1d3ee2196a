// Volume grids by formula: the pyroclastic cloud, and the sphere, slab and torus that tests measure with.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>

#include "grids/grid.hpp"
#include "shared/cloud.h"

namespace brume::grids {

inline constexpr std::uint32_t kMaxCloudEdge = 1024;
inline constexpr std::uint32_t kMaxCloudOctaves = 16;

enum class CloudKind : std::uint32_t {
  pyroclastic = shared::kCloudPyroclastic,  ///< A sphere displaced outwards by |fBm|.
  sphere = shared::kCloudSphere,
  slab = shared::kCloudSlab,    ///< A box of 2 x 1/2 x 2 radii.
  torus = shared::kCloudTorus,  ///< Around y; a tube of a quarter of the radius, at three quarters of it.
};

/// A cube of voxels around the origin, and the shape in its middle. A shape that reaches beyond the cube is
/// cut.
struct CloudSettings {
  CloudKind kind = CloudKind::pyroclastic;
  std::uint32_t edge = 128;  ///< Voxels along each side, [1, kMaxCloudEdge].
  double voxel_size = 0.05;  ///< [m], > 0.
  double radius = 1.8;       ///< [m], > 0; of the sphere before its displacement.
  double edge_width = 0.1;   ///< Depth over which density rises from 0 at the surface to 1 [m]; 0: binary.
  // The displacement of the pyroclastic cloud.
  double amplitude = 0.6;     ///< Displacement where |fBm| is 1 [radii], >= 0.
  double frequency = 1.5;     ///< Lattice cells of the first octave per radius, > 0.
  double gain = 0.5;          ///< Weight of an octave relative to the previous one, [0, 1].
  double lacunarity = 2.0;    ///< Frequency of an octave relative to the previous one, [1, 4].
  std::uint32_t octaves = 6;  ///< [1, kMaxCloudOctaves]
  std::uint32_t seed = 0;
};

/// What CPU and device evaluate.
shared::CloudParams cloud_params(const CloudSettings& settings);

/// Writes the densities of bricks, kBrickVoxels values each in the order of Brick, by the index of their
/// first voxels.
using CloudEvaluator = std::function<void(const shared::CloudParams& params,
                                          std::span<const glm::ivec3> first_voxels, std::span<float> values)>;

/// On all cores.
void evaluate_cloud(const shared::CloudParams& params, std::span<const glm::ivec3> first_voxels,
                    std::span<float> values);

/// A fog volume "density" of float32. Its active voxels are those above 0; bricks without any are absent. The
/// indices of the cube's voxels are 0 to edge - 1. The same bits on every machine and for any number of
/// threads when evaluated on the CPU. Settings outside of their ranges are a caller's error.
Grid generate_cloud(const CloudSettings& settings, const CloudEvaluator& evaluate = evaluate_cloud);

}  // namespace brume::grids
