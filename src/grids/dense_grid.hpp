// Values of a box of voxels, all of them stored: what bakes compute and slice atlases hold.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/box.hpp"
#include "core/error.hpp"
#include "grids/grid.hpp"

namespace brume::grids {

/// Voxel (i, j, k) covers the part [i, i + 1) x [j, j + 1) x [k, k + 1) of `size` equal parts of the box
/// along each axis.
struct DenseGrid {
  std::string name;
  glm::uvec3 size{0};                             ///< Voxels along x, y and z, each at least 1.
  Box<double> box{glm::dvec3(0), glm::dvec3(1)};  ///< low < high along each axis.
  std::vector<float>
      values;  ///< size.x * size.y * size.z of them; voxel (i, j, k) is i + size.x (j + size.y k).

  std::size_t index(glm::uvec3 voxel) const {
    return voxel.x + std::size_t{size.x} * (voxel.y + std::size_t{size.y} * voxel.z);
  }
  glm::dvec3 voxel_size() const { return (box.high - box.low) / glm::dvec3(size); }
};

/// The channels of one volume, of one size and box.
using DenseVolume = std::vector<DenseGrid>;
/// Volumes that others may hold, too.
using DenseVolumes = std::vector<std::shared_ptr<const DenseVolume>>;

/// A fog volume of float32 of the same voxels, all of them active.
Grid to_grid(const DenseGrid& dense, const glm::dmat4& world_from_box = glm::dmat4(1));

/// A box in which the voxels of grids lie along its axes, and how many of them it holds.
struct GridBox {
  glm::dmat4 world_from_box{1};  ///< The identity where the voxels lie along the axes of the world.
  Box<double> box;
  glm::uvec3 size{1};
};

/// Around the active voxels of all grids, in voxels of the first one. Fails with bad_input, without the name
/// of a file: without any, and for grids whose axes differ.
Result<GridBox> box_of(std::span<const Grid* const> grids);

/// The values of a grid in a box: each voxel's mean over what it covers, along axes on which it is larger
/// than the grid's own, and linear between these along others. Voxels at the same place as the grid's have
/// its values as they are. Numbers count as they are, vectors by their length, active voxels of a mask as 1;
/// NaN is 0. Fails as box_of for a grid whose axes are not the box's.
Result<DenseGrid> resample(const Grid& grid, const GridBox& box);

}  // namespace brume::grids
