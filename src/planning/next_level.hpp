// A level as it will be, for what takes long to compute from it.
#pragma once

#include <cstdint>
#include <vector>

#include "voxel/bit_grid.hpp"

namespace brume::planning {

struct NextLevel {
  voxel::BitGrid opaque;  ///< What stops light.
  std::vector<std::uint32_t> hidden_objects;
};

}  // namespace brume::planning
