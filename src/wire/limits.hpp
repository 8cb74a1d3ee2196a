// Limits on untrusted packets and files.
#pragma once

#include <cstdint>

namespace brume::wire {

struct Limits {
  std::uint64_t max_bytes = std::uint64_t{1} << 24;   ///< Of one packet.
  std::uint64_t max_voxels = std::uint64_t{1} << 26;  ///< Of all its sets; a block counts as at least 16.
  std::uint64_t max_items = std::uint64_t{1} << 20;   ///< Of each of its lists.
};

}  // namespace brume::wire
