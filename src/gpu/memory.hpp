// Device memory: shared blocks of 64 MiB, and dedicated allocations from 16 MiB up.
#pragma once

#include <cstddef>
#include <list>
#include <map>
#include <mutex>
#include <vector>

#include "gpu/functions.hpp"

namespace brume::gpu {

enum class MemoryUse {
  device,    ///< Fastest for the device; not visible to the CPU.
  upload,    ///< The CPU writes sequentially, the device reads.
  readback,  ///< The device writes, the CPU reads.
};

class Memory {
 public:
  static constexpr VkDeviceSize kBlockBytes = 64ull << 20;
  static constexpr VkDeviceSize kDedicatedBytes = 16ull << 20;

  struct MemoryBlock;
  /// A range of memory, owned by its holder until `free`.
  struct Range {
    MemoryBlock* block = nullptr;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize offset = 0;
    VkDeviceSize size = 0;
    std::byte* mapped = nullptr;  ///< For upload and readback: coherent, permanently mapped.
  };

  /// With `fill`, every range of memory for the device that the CPU can reach begins with arbitrary values,
  /// as memory that was in use before does: what reads before it writes gives other results.
  Memory(const Functions& vk, VkPhysicalDevice physical_device, VkDevice device, bool fill);
  ~Memory();
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;

  /// Throws resource_limit when the device is out of memory. `tiled` separates images from buffers, so that
  /// bufferImageGranularity never matters.
  Range allocate(const VkMemoryRequirements& needs, MemoryUse use, bool tiled);
  void free(const Range& range) noexcept;

  /// Bytes in live ranges.
  VkDeviceSize bytes_in_use() const;

 private:
  std::uint32_t find_type(std::uint32_t type_bits, MemoryUse use) const;
  MemoryBlock& add_block(VkDeviceSize size, std::uint32_t type, MemoryUse use, bool tiled);
  void fill(const Range& range);

  const Functions& vk_;
  VkDevice device_;
  VkPhysicalDeviceMemoryProperties properties_{};
  mutable std::mutex mutex_;
  std::list<MemoryBlock> blocks_;
  VkDeviceSize bytes_in_use_ = 0;
  bool fill_;
  std::uint32_t filled_ = 0;  // ranges
};

struct Memory::MemoryBlock {
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkDeviceSize size = 0;
  std::uint32_t type = 0;
  bool tiled = false, for_device = false;
  std::byte* mapped = nullptr;
  std::map<VkDeviceSize, VkDeviceSize> holes;  // offset -> size, never adjacent
};

}  // namespace brume::gpu
