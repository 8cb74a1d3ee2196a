// Allocates ranges of one long array. Freed ranges are used again; a range never moves.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "core/error.hpp"

namespace brume::volume {

struct IndexRange {
  std::uint32_t first = 0, count = 0;
  bool operator==(const IndexRange&) const = default;
};

/// Allocates ranges of [0, end) from free lists by size: a range occupies up to a quarter more than `count`,
/// and at least 4.
class RangeArena {
 public:
  /// Throws resource_limit, with nothing changed, when an index would not fit 32 bits.
  IndexRange take(std::uint32_t count) {
    if (count == 0) return {};
    const std::uint32_t size = size_of(count);
    if (std::vector<std::uint32_t>& free = free_[class_of(count)]; !free.empty()) {
      const IndexRange range{free.back(), count};
      free.pop_back();
      in_use_ += size;
      return range;
    }
    if (size > ~std::uint32_t{0} - end_)
      throw Error(ErrorCode::resource_limit, "an array of more than 2^32 entries; use larger voxels");
    const IndexRange range{end_, count};
    end_ += size;
    in_use_ += size;
    return range;
  }
  /// A range from `take`, once.
  void give_back(const IndexRange& range) {
    if (range.count == 0) return;
    in_use_ -= size_of(range.count);
    free_[class_of(range.count)].push_back(range.first);
    if (in_use_ > 0) return;
    for (std::vector<std::uint32_t>& free : free_) free.clear();
    end_ = 0;
  }
  /// One past the highest index of any range since the arena was last empty.
  std::uint32_t end() const { return end_; }

 private:
  /// Sizes are the multiples of a quarter of a power of two: 4, 5, 6, 7, 8, 10, 12, 14, 16, 20...
  static unsigned step_bits(std::uint32_t count) {
    return count <= 4 ? 0u : static_cast<unsigned>(std::bit_width(count - 1)) - 3u;
  }
  static std::uint32_t size_of(std::uint32_t count) {
    if (count <= 4) return 4;
    const std::uint32_t step = 1u << step_bits(count);
    return (count + step - 1) / step * step;
  }
  static std::size_t class_of(std::uint32_t count) {
    const std::uint32_t size = size_of(count);
    return 4 * std::size_t{step_bits(size)} + (size >> step_bits(size)) - 4;
  }

  std::uint32_t end_ = 0, in_use_ = 0;
  std::array<std::vector<std::uint32_t>, 4 * 32> free_;
};

}  // namespace brume::volume
