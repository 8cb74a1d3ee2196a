// How much of a volume file is read.
#pragma once

#include <cstdint>

namespace brume::grids {

/// Beyond these a file is refused (resource_limit) before anything of that size is allocated.
struct GridLimits {
  std::uint64_t bytes = 1ull << 33;          ///< Of memory_of() all grids.
  std::uint64_t active_voxels = 1ull << 33;  ///< Of a grid, tiles included.
  double seconds = 600;                      ///< Processor time of the child process.
};

}  // namespace brume::grids
