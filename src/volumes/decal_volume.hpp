// Grids of files as dense volumes that decals and particles sample.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "core/error.hpp"
#include "grids/dense_grid.hpp"
#include "grids/slice_layout.hpp"

namespace brume::volumes {

/// Where a mesh is whose occlusion volumes hold: inside of it both are large, outside one of them is small.
struct Occluder {
  glm::dvec3 middle{0};
  double radius = 0;  ///< 0: unknown.
};

/// The mean of places and, times sqrt(2), their deviation: the radius of a disk of that deviation.
Occluder occluder_of(const grids::DenseGrid& up, const grids::DenseGrid& down);

/// Grids of a file, resampled to one box.
struct SampledGrids {
  std::shared_ptr<const grids::DenseVolume> volume;
  glm::dmat4 file_from_box{1};
  Occluder occluder = {};  ///< In the box, where the decal's channels differ.
};

/// The grid of a name; null: there is none.
const grids::Grid* find_grid(const grids::GridFile& file, const std::string& name);

/// Fails as grids::box_of and grids::resample, and with resource_limit for more voxels; without the name of
/// the file.
Result<SampledGrids> sample_grids(std::span<const grids::Grid* const> chosen,
                                  std::uint64_t most_voxels = grids::kMostAtlasTexels);

/// The occlusion of what faces up and of what faces down in a file: the grid of a name for both, or without
/// one the grids "up" and "down", or else the first grid for both. Fails as sample_grids, and with bad_input
/// for a grid that does not exist.
Result<SampledGrids> decal_volume(const grids::GridFile& file, const std::string& grid);

}  // namespace brume::volumes
