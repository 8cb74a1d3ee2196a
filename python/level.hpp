// The class Level of the module.
#pragma once

#include <memory>

#include "python/calls.hpp"
#include "scenario/voxel_cache.hpp"

namespace brume::python {

/// The voxels of a level and the planes of its surfaces; they never change.
struct Level {
  std::shared_ptr<const scenario::Voxels> voxels;
  const voxel::BitGrid& grid() const { return voxels->grid; }
};

void bind_level(py::module_& module);

}  // namespace brume::python
