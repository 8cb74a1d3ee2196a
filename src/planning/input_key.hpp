// What something was computed from, byte by byte.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>

#include "core/frame_memory.hpp"

namespace brume::planning {

/// Equal keys, equal results: each cache adds all that its result follows from, in one order. Where what is
/// added varies in number, the number is part of the key.
class InputKey {
 public:
  InputKey() = default;
  /// A copy is on the heap, as copies of a FrameVector are.
  explicit InputKey(Allocator memory) : bytes_(memory) {}

  template <typename T>
  requires std::is_trivially_copyable_v<T>
  void add(const T& value) { append(std::as_bytes(std::span(&value, 1))); }
  template <typename List>
  void add_list(const List& values) {
    add(values.size());
    append(std::as_bytes(std::span(values)));
  }
  /// Nothing was computed yet, or what was is lost.
  void clear() { bytes_.clear(); }
  bool empty() const { return bytes_.empty(); }
  bool operator==(const InputKey& other) const = default;

 private:
  void append(std::span<const std::byte> bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }

  FrameVector<std::byte> bytes_;
};

}  // namespace brume::planning
