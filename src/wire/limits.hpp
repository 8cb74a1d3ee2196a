// Limits on untrusted packets and files.
#pragma once

#include <cstdint>

namespace brume::wire {

struct Limits {
  std::uint64_t max_bytes = std::uint64_t{1} << 24;  ///< Bytes of one packet.
  std::uint64_t max_voxels = std::uint64_t{1}
                             << 26;  ///< Voxels of all its sets; a block counts as at least 16.
  std::uint64_t max_items = std::uint64_t{1} << 20;  ///< Length of each of its lists.
};

}  // namespace brume::wire
