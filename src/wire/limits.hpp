// How much a packet or a file from anywhere may ask for.
#pragma once

#include <cstdint>

namespace brume::wire {

struct Limits {
  std::uint64_t max_bytes = std::uint64_t{1} << 24;   ///< Of a packet.
  std::uint64_t max_voxels = std::uint64_t{1} << 26;  ///< Of all sets in it; a block counts as 16 at least.
  std::uint64_t max_items = std::uint64_t{1} << 20;   ///< Of each list in it.
};

}  // namespace brume::wire
