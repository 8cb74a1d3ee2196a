// What something was computed from, byte by byte: equal bytes, equal result.
#pragma once

#include <cstddef>
#include <cstring>
#include <type_traits>
#include <utility>

#include "core/frame_memory.hpp"

namespace brume::planning {

class KeyBytes {
 public:
  explicit KeyBytes(Allocator memory) : bytes_(memory) {}
  template <typename T>
  requires std::is_trivially_copyable_v<T>
  void add(const T& value) {
    const std::size_t end = bytes_.size();
    bytes_.resize(end + sizeof value);
    std::memcpy(bytes_.data() + end, &value, sizeof value);
  }
  FrameVector<std::byte> take() { return std::move(bytes_); }

 private:
  FrameVector<std::byte> bytes_;
};

}  // namespace brume::planning
