#include "core/frame_memory.hpp"

#include <algorithm>

namespace brume {

void FrameMemory::add_block(std::size_t size) {
  blocks_.push_back({std::make_unique_for_overwrite<std::byte[]>(size), size});
  capacity_ += size;
  next_ = blocks_.back().bytes.get();
  left_ = size;
}

void FrameMemory::reset() {
  if (blocks_.empty()) return;
  // One block for the next frame, as large as all blocks of this one together.
  if (blocks_.size() > 1) {
    const std::size_t size = capacity_;
    blocks_.clear();
    next_ = nullptr;
    left_ = capacity_ = 0;
    add_block(size);
  }
  next_ = blocks_.back().bytes.get();
  left_ = blocks_.back().size;
}

void* FrameMemory::do_allocate(std::size_t size, std::size_t alignment) {
  constexpr std::size_t kLeastBlock = 1u << 14;
  void* at = next_;
  if (!std::align(alignment, size, at, left_)) {
    add_block(std::max({size + alignment, kLeastBlock, capacity_}));
    at = next_;
    std::align(alignment, size, at, left_);
  }
  next_ = static_cast<std::byte*>(at) + size;
  left_ -= size;
  return at;
}

}  // namespace brume
