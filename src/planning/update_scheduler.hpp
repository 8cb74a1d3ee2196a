// Time-sliced updates: work that is spread over frames, a few slices of it in each.
#pragma once

#include <cstdint>

namespace brume::planning {

/// Chooses the slices of work that a frame updates, and counts the frames until all of them are up to date.
/// Slices follow each other in bit-reversed order (van der Corput), so that consecutive frames update
/// different halves, quarters and so on.
class UpdateScheduler {
 public:
  /// `slice_count` is a power of two.
  explicit UpdateScheduler(std::uint32_t slice_count) : slice_count_(slice_count), per_frame_(slice_count) {}

  /// Slices one after the other, [first, end).
  struct SliceRange {
    std::uint32_t first = 0, end = 0;
    std::uint32_t mask() const { return (1u << end) - (1u << first); }
  };

  std::uint32_t slice_count() const { return slice_count_; }
  /// Whether a frame that updates this fraction, in (0, 1], takes no more than one slice.
  bool takes_one_slice(float update_fraction) const { return slices_for(update_fraction) == 1; }

  /// Begins a frame that updates about a fraction, in (0, 1], of the work: the least power of two of slices
  /// that is not less. They are the next ones in the order.
  void next_slice(float update_fraction);
  /// The slices of the frame, aligned to their number. A priority, a power of two, multiplies that number, up
  /// to all of them; each slice is still updated once in a round, which takes fewer frames.
  SliceRange slices(std::uint32_t priority = 1) const;
  /// How many slices that are.
  std::uint32_t slices_per_frame(std::uint32_t priority = 1) const;
  /// Whether the frame updates less than all of the work.
  bool is_sliced() const { return per_frame_ < slice_count_; }

  /// Frames, of one slice each, until all of the work is up to date.
  std::uint32_t pending() const { return pending_; }
  /// The work changed: all slices are due again.
  void restart() { pending_ = slice_count_; }
  /// One slice of those that are due was updated.
  void complete_slice() { pending_ -= pending_ > 0 ? 1 : 0; }
  /// All of the work was updated.
  void complete() { pending_ = 0; }

 private:
  std::uint32_t slices_for(float update_fraction) const;

  std::uint32_t slice_count_;
  std::uint32_t per_frame_, first_ = 0;  // slices of the frame
  std::uint32_t frame_ = 0, pending_ = 0;
};

}  // namespace brume::planning
