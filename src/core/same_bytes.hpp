// Equality of values as they lie in memory.
#pragma once

#include <cstring>
#include <type_traits>

namespace brume {

/// Whether two values have the same bytes: of types without padding, such as those shared with shaders.
template <typename T>
requires std::is_trivially_copyable_v<T>
bool same_bytes(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}

}  // namespace brume
