#include "planning/update_scheduler.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace brume::planning {
namespace {

std::vector<std::uint32_t> first_slices(UpdateScheduler& scheduler, float fraction, int frames) {
  std::vector<std::uint32_t> first;
  for (int i = 0; i < frames; ++i) {
    scheduler.next_slice(fraction);
    first.push_back(scheduler.slices().first);
  }
  return first;
}

TEST(UpdateScheduler, SlicesFollowInBitReversedOrder) {
  UpdateScheduler four(4), sixteen(16);
  EXPECT_EQ(first_slices(four, 0.25f, 5), (std::vector<std::uint32_t>{0, 2, 1, 3, 0}));
  EXPECT_EQ(first_slices(sixteen, 0.01f, 17),
            (std::vector<std::uint32_t>{0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15, 0}));
}

TEST(UpdateScheduler, AFrameTakesTheLeastPowerOfTwoThatIsNoLess) {
  UpdateScheduler scheduler(16);
  for (const auto& [fraction, slices] : {std::pair(1.0f, 16u),
                                         {0.6f, 16u},
                                         {0.5f, 8u},
                                         {0.3f, 8u},
                                         {0.25f, 4u},
                                         {0.0626f, 2u},
                                         {0.0625f, 1u},
                                         {0.001f, 1u}}) {
    scheduler.next_slice(fraction);
    EXPECT_EQ(scheduler.slices_per_frame(), slices) << fraction;
    EXPECT_EQ(scheduler.is_sliced(), slices < 16) << fraction;
    EXPECT_EQ(scheduler.takes_one_slice(fraction), slices == 1) << fraction;
  }
}

TEST(UpdateScheduler, EverySliceIsUpdatedOnceARoundWithAnyPriority) {
  for (const std::uint32_t priority : {1u, 2u, 4u, 16u})
    for (const float fraction : {1.0f, 0.5f, 0.25f, 0.125f, 0.0625f}) {
      UpdateScheduler scheduler(16);
      std::uint32_t updated = 0;
      for (std::uint32_t frame = 0; updated != 0xffff; ++frame) {
        scheduler.next_slice(fraction);
        const auto slices = scheduler.slices(priority);
        EXPECT_EQ(slices.end - slices.first, scheduler.slices_per_frame(priority));
        EXPECT_EQ(updated & slices.mask(), 0u) << "none twice";
        updated |= slices.mask();
        ASSERT_LT(frame, 16 / scheduler.slices_per_frame(priority));
      }
    }
}

TEST(UpdateScheduler, CountsTheFramesUntilAllIsUpToDate) {
  UpdateScheduler scheduler(4);
  EXPECT_EQ(scheduler.pending(), 0u);
  scheduler.restart();
  for (std::uint32_t left = 4; left > 0; --left) {
    EXPECT_EQ(scheduler.pending(), left);
    scheduler.complete_slice();
  }
  scheduler.complete_slice();
  EXPECT_EQ(scheduler.pending(), 0u);
  scheduler.restart();
  scheduler.complete();
  EXPECT_EQ(scheduler.pending(), 0u);
}

}  // namespace
}  // namespace brume::planning
