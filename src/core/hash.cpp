#include "core/hash.hpp"

// All of xxHash from its header: a server does not need the library.
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace brume {

std::uint64_t hash_bytes(std::span<const std::byte> bytes, std::uint64_t seed) {
  return XXH3_64bits_withSeed(bytes.data(), bytes.size(), seed);
}

}  // namespace brume
