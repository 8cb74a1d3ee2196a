// Device memory: shared blocks, and dedicated allocations for what is large.
#pragma once

#include <atomic>
#include <cstddef>
#include <list>
#include <mutex>
#include <vector>

#include "gpu/functions.hpp"

namespace brume::gpu {

enum class MemoryUse {
  device,    ///< Fastest for the device; not visible to the CPU.
  upload,    ///< The CPU writes sequentially, the device reads.
  readback,  ///< The device writes, the CPU reads.
};

/// How a host allocates the memory of its device itself; null: by vkAllocateMemory and vkFreeMemory.
struct MemoryCallbacks {
  void* user = nullptr;
  VkResult (*allocate)(void* user, const VkMemoryAllocateInfo* info, VkDeviceMemory* memory) = nullptr;
  void (*free)(void* user, VkDeviceMemory memory, VkDeviceSize size) = nullptr;
};

struct MemoryOptions {
  /// Every range of memory for the device that the CPU can reach begins with arbitrary values, as memory that
  /// was in use before does: what reads before it writes gives other results.
  bool fill = false;
  VkDeviceSize block_bytes = 64ull << 20;
  VkDeviceSize dedicated_bytes = 16ull << 20;  ///< From this size on; no more than block_bytes.
  MemoryCallbacks callbacks{};
};

class Memory {
 public:
  static constexpr VkDeviceSize kNoLimit = ~VkDeviceSize{0};

  struct MemoryBlock;
  /// A range of memory, owned by its holder until `free`.
  struct Range {
    MemoryBlock* block = nullptr;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize offset = 0;
    VkDeviceSize size = 0;
    std::byte* mapped = nullptr;  ///< For upload and readback: coherent, permanently mapped.
  };

  Memory(const Functions& vk, VkPhysicalDevice physical_device, VkDevice device,
         const MemoryOptions& options = {});
  ~Memory();
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;

  /// Throws resource_limit when the device is out of memory or the limit is reached. `tiled` separates images
  /// from buffers, so that bufferImageGranularity never matters.
  Range allocate(const VkMemoryRequirements& needs, MemoryUse use, bool tiled);
  void free(const Range& range) noexcept;
  /// A range in use is to be freed when the device is done with it: the limit does not count it any more.
  void retire(const Range& range) noexcept;

  /// Bytes in ranges that are not freed.
  VkDeviceSize bytes_in_use() const;
  /// Bytes of ranges for the device that are neither freed nor retired: what the limit counts.
  VkDeviceSize device_bytes() const;
  /// Bytes that were allocated from the device for ranges of all kinds, used or not.
  VkDeviceSize allocated_bytes() const;

  /// Ranges for the device beyond this many bytes are refused. What is in use stays.
  void set_limit(VkDeviceSize bytes);
  VkDeviceSize limit() const;
  /// While one exists, the limit refuses nothing: for what takes the place of something larger.
  class Unlimited {
   public:
    explicit Unlimited(Memory& memory) : memory_(memory) { ++memory_.unlimited_; }
    ~Unlimited() { --memory_.unlimited_; }
    Unlimited(const Unlimited&) = delete;
    Unlimited& operator=(const Unlimited&) = delete;

   private:
    Memory& memory_;
  };

 private:
  std::uint32_t find_type(std::uint32_t type_bits, MemoryUse use) const;
  MemoryBlock& add_block(VkDeviceSize size, std::uint32_t type, MemoryUse use, bool tiled);
  void fill(const Range& range);
  VkResult allocate_block(const VkMemoryAllocateInfo& info, VkDeviceMemory& memory) const;
  void free_block(const MemoryBlock& block) const noexcept;

  const Functions& vk_;
  VkDevice device_;
  VkPhysicalDeviceMemoryProperties properties_{};
  mutable std::mutex mutex_;
  std::list<MemoryBlock> blocks_;
  VkDeviceSize bytes_in_use_ = 0, device_bytes_ = 0, allocated_bytes_ = 0;
  VkDeviceSize limit_ = kNoLimit;
  std::atomic<int> unlimited_ = 0;
  MemoryOptions options_;
  std::uint32_t filled_ = 0;  // ranges
};

struct Memory::MemoryBlock {
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkDeviceSize size = 0;
  std::uint32_t type = 0;
  bool tiled = false, for_device = false;
  std::byte* mapped = nullptr;
  struct Hole {
    VkDeviceSize offset = 0, size = 0;
  };
  // With room for what each range may leave, so that nothing is allocated when it is freed.
  std::vector<Hole> holes;            // rising, never adjacent
  std::vector<VkDeviceSize> retired;  // offsets of ranges that are to be freed
  std::size_t ranges = 0;             // how many are not freed

  bool is_empty() const { return ranges == 0; }
};

}  // namespace brume::gpu
