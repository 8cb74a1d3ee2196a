#include <algorithm>
#include <cmath>
#include <random>

#include "core/error.hpp"
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

TEST_F(GpuTest, TheLimitOfMemoryCountsWhatIsInUseOnTheDevice) {
  Memory memory(context().vk(), context().info().handle, context().device());
  const auto allocate = [&](VkDeviceSize bytes, MemoryUse use = MemoryUse::device) {
    return memory.allocate({bytes, 16, ~0u}, use, false);
  };
  memory.set_limit(4096);
  const auto first = allocate(3072);
  EXPECT_THROW(allocate(1025), Error);
  allocate(1 << 20, MemoryUse::upload);  // of the CPU
  const auto second = allocate(1024);
  EXPECT_EQ(memory.device_bytes(), 4096u);
  EXPECT_THROW(allocate(1), Error);
  // What frames in flight still use does not count; it is freed once.
  memory.retire(first);
  memory.retire(first);
  EXPECT_EQ(memory.device_bytes(), 1024u);
  const auto third = allocate(3072);
  memory.free(first);
  EXPECT_EQ(memory.device_bytes(), 4096u);
  {
    const Memory::Unlimited replaced(memory);
    memory.free(allocate(1 << 20));
  }
  EXPECT_THROW(allocate(1 << 20), Error);
  // A limit below what is in use refuses, and takes nothing away.
  memory.set_limit(0);
  EXPECT_EQ(memory.device_bytes(), 4096u);
  EXPECT_THROW(allocate(1), Error);
  memory.set_limit(Memory::kNoLimit);
  memory.free(allocate(1 << 20));
  memory.free(second);
  memory.free(third);
  EXPECT_EQ(memory.device_bytes(), 0u);
}

/// A host's memory, which fails once.
struct CountingHost {
  const Context* context = nullptr;
  int allocated = 0, freed = 0, fails_at = 0;
  VkDeviceSize bytes = 0;

  static VkResult allocate(void* user, const VkMemoryAllocateInfo* info, VkDeviceMemory* memory) {
    auto& own = *static_cast<CountingHost*>(user);
    if (++own.allocated == own.fails_at) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    own.bytes += info->allocationSize;
    return own.context->vk().AllocateMemory(own.context->device(), info, nullptr, memory);
  }
  static void free(void* user, VkDeviceMemory memory, VkDeviceSize size) {
    auto& own = *static_cast<CountingHost*>(user);
    ++own.freed;
    own.bytes -= size;
    own.context->vk().FreeMemory(own.context->device(), memory, nullptr);
  }
};

TEST_F(GpuTest, MemoryComesFromTheHostWhereItSaysHow) {
  CountingHost host{&context()};
  host.fails_at = 2;
  {
    Memory memory(context().vk(), context().info().handle, context().device(),
                  {.block_bytes = 1 << 16,
                   .dedicated_bytes = 1 << 15,
                   .callbacks = {&host, CountingHost::allocate, CountingHost::free}});
    const auto small = memory.allocate({100, 16, ~0u}, MemoryUse::device, false);
    EXPECT_THROW(memory.allocate({1 << 20, 16, ~0u}, MemoryUse::device, false), Error);
    const auto large = memory.allocate({1 << 20, 16, ~0u}, MemoryUse::device, false);
    EXPECT_EQ(host.bytes, memory.allocated_bytes());
    EXPECT_EQ(host.bytes, (1u << 20) + (1u << 16));
    memory.free(large);
    memory.free(small);
    EXPECT_EQ(host.bytes, 1u << 16) << "one shared block is kept";
  }
  EXPECT_EQ(host.bytes, 0u);
  EXPECT_EQ(host.freed, host.allocated - 1);
}

// What reads a texel or a word before it is written then gives another result each time.
TEST_F(GpuTest, MemoryOfTestsBeginsWithArbitraryFiniteValues) {
  if (context().info().kind != DeviceKind::cpu) GTEST_SKIP() << "the CPU does not reach the device's memory";
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
