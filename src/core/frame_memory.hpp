// Memory for what lives no longer than a frame.
#pragma once

#include <cstddef>
#include <memory>
#include <memory_resource>
#include <vector>

namespace brume {

/// Hands out memory in order and takes it back all at once. What a frame took the next one has without a
/// heap: frames that need no more than those before allocate nothing. Not for several threads at a time.
class FrameMemory final : public std::pmr::memory_resource {
 public:
  FrameMemory() = default;
  FrameMemory(const FrameMemory&) = delete;
  FrameMemory& operator=(const FrameMemory&) = delete;

  /// Takes everything back: nothing that was allocated may be used any more.
  void reset();
  /// Bytes that are held for frames.
  std::size_t capacity() const { return capacity_; }

 private:
  struct Block {
    std::unique_ptr<std::byte[]> bytes;
    std::size_t size = 0;
  };
  void add_block(std::size_t size);
  void* do_allocate(std::size_t size, std::size_t alignment) override;
  void do_deallocate(void*, std::size_t, std::size_t) override {}
  bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override { return this == &other; }

  std::vector<Block> blocks_;  // the last one is in use
  std::byte* next_ = nullptr;
  std::size_t left_ = 0, capacity_ = 0;
};

/// Where lists are: of a FrameMemory by its address, or, by default, of the heap.
using Allocator = std::pmr::polymorphic_allocator<>;

/// A list that lives no longer than a frame, where it is given a FrameMemory; a copy of it is on the heap.
template <typename T>
using FrameVector = std::pmr::vector<T>;

}  // namespace brume
