// Pages of cached shadow rays on the device (shared/smoke_light.h), by their numbers.
#pragma once

#include <cstddef>
#include <cstdint>

namespace brume::planning {

/// Most pages at a time; of shared::kTexelsPerBrick words: 128 MB.
constexpr std::uint32_t kMaxRayPages = 1u << 15;

/// Hands out pages one after the other, and takes them back all at once.
class RayPagePool {
 public:
  explicit RayPagePool(std::uint32_t capacity) : capacity_(capacity) {}

  /// The first of `count` pages that follow each other. The caller checks `fits` before.
  std::uint32_t allocate(std::uint32_t count) {
    const std::uint32_t first = used_;
    used_ += count;
    return first;
  }
  bool fits(std::size_t count) const { return used_ + count <= capacity_; }
  std::uint32_t used() const { return used_; }
  void clear() { used_ = 0; }

 private:
  std::uint32_t capacity_, used_ = 0;
};

}  // namespace brume::planning
