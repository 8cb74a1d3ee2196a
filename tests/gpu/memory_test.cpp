#include <algorithm>
#include <cmath>
#include <random>

#include "tests/gpu/gpu_test.hpp"

namespace brume::gpu {
namespace {

struct Live {
  Memory::Range range;
  VkDeviceSize alignment;
};

bool overlap(const Memory::Range& a, const Memory::Range& b) {
  return a.memory == b.memory && a.offset < b.offset + b.size && b.offset < a.offset + a.size;
}

TEST_F(GpuTest, MemoryRangesNeverOverlap) {
  Memory memory(context().vk(), context().info().handle, context().device());
  std::mt19937 random(1);
  std::vector<Live> live;
  for (int i = 0; i < 2000; ++i) {
    if (!live.empty() && random() % 3 == 0) {
      const std::size_t victim = random() % live.size();
      memory.free(live[victim].range);
      live[victim] = live.back();
      live.pop_back();
      continue;
    }
    const VkMemoryRequirements needs{1 + random() % 70000, VkDeviceSize{1} << random() % 12, ~0u};
    const Live added{memory.allocate(needs, MemoryUse::device, random() % 2 == 0), needs.alignment};
    EXPECT_EQ(added.range.offset % needs.alignment, 0u);
    for (const Live& other : live) ASSERT_FALSE(overlap(added.range, other.range));
    live.push_back(added);
  }
  VkDeviceSize sum = 0;
  for (const Live& one : live) sum += one.range.size;
  EXPECT_EQ(memory.bytes_in_use(), sum);
  for (const Live& one : live) memory.free(one.range);
  EXPECT_EQ(memory.bytes_in_use(), 0u);
}

TEST_F(GpuTest, LargeRangesHaveDedicatedMemory) {
  Memory memory(context().vk(), context().info().handle, context().device());
  const auto small = memory.allocate({1024, 16, ~0u}, MemoryUse::device, false);
  const auto large = memory.allocate({MemoryOptions().dedicated_bytes, 16, ~0u}, MemoryUse::device, false);
  const auto next = memory.allocate({1024, 16, ~0u}, MemoryUse::device, false);
  EXPECT_NE(small.memory, large.memory);
  EXPECT_EQ(small.memory, next.memory);
  EXPECT_EQ(large.offset, 0u);
  memory.free(small);
  memory.free(large);
  memory.free(next);
}

// What reads a texel or a word before it is written then gives another result each time.
TEST_F(GpuTest, MemoryOfTestsBeginsWithArbitraryFiniteValues) {
  if (context().info().kind != "cpu") GTEST_SKIP() << "the CPU does not reach the device's memory";
  constexpr std::size_t kWords = 1000;
  constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
  const Buffer first(context(), kWords * sizeof(float), kUsage),
      second(context(), kWords * sizeof(float), kUsage);
  const auto values = read_back<float>(first, kWords);
  EXPECT_NE(values, read_back<float>(second, kWords));
  EXPECT_TRUE(std::ranges::all_of(values, [](float value) { return std::isfinite(value); }));
}

}  // namespace
}  // namespace brume::gpu
