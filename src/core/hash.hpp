// 64-bit hashes of bytes (XXH3), for cache keys and state checks. Not for security.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace brume {

/// XXH3-64 of the bytes, continued from `seed`.
std::uint64_t hash_bytes(std::span<const std::byte> bytes, std::uint64_t seed = 0);

/// The hash of a range of plain values without padding, continued from `seed`.
template <typename T>
requires std::has_unique_object_representations_v<T> || std::is_floating_point_v<T> std::uint64_t hash_values(
    std::span<const T> values, std::uint64_t seed = 0) {
  return hash_bytes(std::as_bytes(values), seed);
}

}  // namespace brume
