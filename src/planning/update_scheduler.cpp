#include "planning/update_scheduler.hpp"

#include <algorithm>

namespace brume::planning {

std::uint32_t UpdateScheduler::slices_for(float update_fraction) const {
  const float at_least = update_fraction * static_cast<float>(slice_count_);
  std::uint32_t slices = slice_count_;
  while (slices > 1 && static_cast<float>(slices / 2) >= at_least) slices /= 2;
  return slices;
}

void UpdateScheduler::next_slice(float update_fraction) {
  per_frame_ = slices_for(update_fraction);
  first_ = 0;
  for (std::uint32_t bit = slice_count_ / 2, frame = frame_++ % slice_count_; bit >= per_frame_;
       bit /= 2, frame /= 2)
    first_ += frame % 2 * bit;
}

std::uint32_t UpdateScheduler::slices_per_frame(std::uint32_t priority) const {
  return std::min(priority * per_frame_, slice_count_);
}

UpdateScheduler::SliceRange UpdateScheduler::slices(std::uint32_t priority) const {
  const std::uint32_t count = slices_per_frame(priority);
  const std::uint32_t first = first_ / count * count;
  return {first, first + count};
}

}  // namespace brume::planning
