#include "core/frame_memory.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <random>

namespace brume {
namespace {

TEST(FrameMemory, RangesAreAlignedAndApart) {
  FrameMemory memory;
  std::mt19937 random(1);
  for (int frame = 0; frame < 5; ++frame) {
    memory.reset();
    std::map<std::uintptr_t, std::size_t> ranges;  // first byte, size
    for (int i = 0; i < 500; ++i) {
      const std::size_t size = random() % 3000, alignment = std::size_t{1} << random() % 8;
      void* const at = memory.allocate(size, alignment);
      const auto first = reinterpret_cast<std::uintptr_t>(at);
      ASSERT_EQ(first % alignment, 0u);
      std::memset(at, i, size);
      if (size == 0) continue;
      const auto next = ranges.lower_bound(first);
      ASSERT_TRUE(next == ranges.end() || first + size <= next->first);
      ASSERT_TRUE(next == ranges.begin() || std::prev(next)->first + std::prev(next)->second <= first);
      ranges[first] = size;
    }
  }
}

// Larger than any block so far, so that each has one of its own, whose first byte is rarely aligned.
TEST(FrameMemory, LargeRangesHaveRoomForTheirAlignment) {
  FrameMemory memory;
  for (std::size_t size = std::size_t{1} << 16; size <= std::size_t{1} << 20; size *= 2) {
    constexpr std::size_t kAlignment = 4096;
    void* const at = memory.allocate(size, kAlignment);
    ASSERT_EQ(reinterpret_cast<std::uintptr_t>(at) % kAlignment, 0u);
    std::memset(at, 1, size);  // The address sanitizer knows where the block ends.
    EXPECT_GE(memory.capacity(), size + kAlignment - alignof(std::max_align_t)) << "of the smallest block";
  }
}

TEST(FrameMemory, FramesAlikeTakeTheMemoryOfTheFirst) {
  FrameMemory memory;
  const auto frame = [&] {
    memory.reset();
    FrameVector<int> list(&memory);
    for (int i = 0; i < 100'000; ++i) list.push_back(i);
    EXPECT_EQ(list.back(), 99'999);
    return memory.capacity();
  };
  EXPECT_EQ(memory.capacity(), 0u);
  frame();
  const std::size_t capacity = frame();
  for (int i = 0; i < 10; ++i) EXPECT_EQ(frame(), capacity);
}

TEST(FrameMemory, CopiesOfListsAreOnTheHeap) {
  FrameMemory memory;
  const FrameVector<int> list({1, 2, 3}, &memory);
  const FrameVector<int> copy = list;
  EXPECT_EQ(copy.get_allocator().resource(), std::pmr::get_default_resource());
  memory.reset();
  FrameVector<int>({7, 7, 7}, &memory);
  EXPECT_EQ(copy, (FrameVector<int>{1, 2, 3}));
}

}  // namespace
}  // namespace brume
