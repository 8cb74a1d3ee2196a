// How much of a volume file is read.
#pragma once

#include <atomic>
#include <cstdint>

namespace brume::grids {

/// Beyond these a file is refused (resource_limit) before anything of that size is allocated.
struct GridLimits {
  std::uint64_t bytes = 1ull << 33;          ///< Sum of memory_of() all grids.
  std::uint64_t active_voxels = 1ull << 33;  ///< Active voxels of a grid, tiles included.
  /// Voxels of a tank of spheres; one of more is reduced until it fits (tank_grids).
  std::uint64_t tank_voxels = 1ull << 28;
  double seconds = 600;  ///< Processor time of the child process.
  /// Once it is true, reading fails soon: what is read is no longer wanted. Null: never.
  const std::atomic<bool>* stopped = nullptr;

  bool is_stopped() const { return stopped && *stopped; }
};

}  // namespace brume::grids
