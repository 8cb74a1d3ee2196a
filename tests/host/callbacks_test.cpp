// A host that gives the driver the memory of the CPU for what Brume creates.
#include <cstdlib>
#include <map>

#include "tests/host/yard.hpp"

namespace brume::host {
namespace {

/// Blocks that the driver has. A block of another allocator's, and one that it never frees, are failures.
class DriverMemory {
 public:
  VkAllocationCallbacks callbacks() {
    VkAllocationCallbacks made{};
    made.pUserData = this;
    made.pfnAllocation = [](void* self, std::size_t size, std::size_t alignment, VkSystemAllocationScope) {
      return static_cast<DriverMemory*>(self)->allocate(size, alignment);
    };
    made.pfnReallocation = [](void* self, void* before, std::size_t size, std::size_t alignment,
                              VkSystemAllocationScope) {
      return static_cast<DriverMemory*>(self)->reallocate(before, size, alignment);
    };
    made.pfnFree = [](void* self, void* block) { static_cast<DriverMemory*>(self)->free(block); };
    return made;
  }
  std::size_t blocks() {
    const std::scoped_lock lock(mutex_);
    return sizes_.size();
  }
  int allocations = 0;

 private:
  void* allocate(std::size_t size, std::size_t alignment) {
    const std::scoped_lock lock(mutex_);
    void* const block = std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    if (block) sizes_[block] = size;
    ++allocations;
    return block;
  }
  void* reallocate(void* before, std::size_t size, std::size_t alignment) {
    if (!before) return allocate(size, alignment);
    void* const block = size > 0 ? allocate(size, alignment) : nullptr;
    if (block) std::memcpy(block, before, std::min(size, size_of(before)));
    if (block || size == 0) free(before);
    return block;
  }
  std::size_t size_of(void* block) {
    const std::scoped_lock lock(mutex_);
    return sizes_.at(block);
  }
  void free(void* block) {
    if (!block) return;
    const std::scoped_lock lock(mutex_);
    EXPECT_EQ(sizes_.erase(block), 1u) << "allocated by others";
    std::free(block);
  }

  std::mutex mutex_;
  std::map<void*, std::size_t> sizes_;
};

class CallbacksTest : public YardTest {
 protected:
  CallbacksTest() : YardTest(gpu::kUsualHost, {16, 9}) { allocation_callbacks_ = &callbacks_; }

  DriverMemory driver_;
  const VkAllocationCallbacks callbacks_ = driver_.callbacks();
};

TEST_F(CallbacksTest, TheDriverTakesAndFreesMemoryOfTheHost) {
  make({32, 16, 32}, 0.25f);
  smoke(1, {3, 0.6f, 3}, 500, 100);
  advance(40);
  brume_frame_params like = brume_frame_defaults();
  like.picture.format = VK_FORMAT_R16G16B16A16_SFLOAT;
  ASSERT_OK(brume_device_compile(device_, nullptr, &like));
  for (int frame = 0; frame < 6; ++frame) {
    draw({1, 2, 1}, {1, -0.1f, 1}, 0.7);
    if (frame == 3) resize({33, 17});
  }
  EXPECT_GT(driver_.blocks(), 0u);
  host_.wait();
  EXPECT_OK(brume_renderer_destroy(std::exchange(renderer_, nullptr)));
  EXPECT_OK(brume_device_destroy(std::exchange(device_, nullptr)));
  EXPECT_EQ(driver_.blocks(), 0u) << "of " << driver_.allocations;
}

}  // namespace
}  // namespace brume::host
