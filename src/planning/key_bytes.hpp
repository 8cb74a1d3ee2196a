// What something was computed from, byte by byte: equal bytes, equal result.
#pragma once

#include <cstddef>
#include <cstring>
#include <type_traits>
#include <utility>
#include <vector>

namespace brume::planning {

class KeyBytes {
 public:
  template <typename T>
  requires std::is_trivially_copyable_v<T>
  void add(const T& value) {
    const std::size_t end = bytes_.size();
    bytes_.resize(end + sizeof value);
    std::memcpy(bytes_.data() + end, &value, sizeof value);
  }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

}  // namespace brume::planning
