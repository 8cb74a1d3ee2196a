#include "gpu/memory.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <string>

#include "core/error.hpp"

namespace brume::gpu {
namespace {

VkDeviceSize align_up(VkDeviceSize value, VkDeviceSize alignment) {
  return (value + alignment - 1) / alignment * alignment;
}

/// Allocates an aligned range from the first hole that fits it.
std::optional<VkDeviceSize> take(std::map<VkDeviceSize, VkDeviceSize>& holes, VkDeviceSize size,
                                 VkDeviceSize alignment) {
  for (auto hole = holes.begin(); hole != holes.end(); ++hole) {
    const auto [begin, length] = *hole;
    const VkDeviceSize offset = align_up(begin, alignment);
    if (offset + size > begin + length) continue;
    holes.erase(hole);
    if (offset > begin) holes[begin] = offset - begin;
    if (offset + size < begin + length) holes[offset + size] = begin + length - offset - size;
    return offset;
  }
  return std::nullopt;
}

/// Frees a range, merging it with adjacent holes.
void give(std::map<VkDeviceSize, VkDeviceSize>& holes, VkDeviceSize offset, VkDeviceSize size) {
  auto next = holes.lower_bound(offset);
  if (next != holes.end() && offset + size == next->first) {
    size += next->second;
    next = holes.erase(next);
  }
  if (next != holes.begin()) {
    const auto previous = std::prev(next);
    if (previous->first + previous->second == offset) {
      previous->second += size;
      return;
    }
  }
  holes[offset] = size;
}

// What an allocation needs and what there is, for its failure.
std::string allocation_text(VkDeviceSize size, VkDeviceSize in_use, const VkMemoryHeap& heap) {
  const auto mebibytes = [](VkDeviceSize bytes) {
    return std::to_string((bytes + (1u << 20) - 1) >> 20) + " MiB";
  };
  return "allocating " + mebibytes(size) + " besides the " + mebibytes(in_use) + " in use, in a heap of " +
         mebibytes(heap.size) + ",";
}

}  // namespace

Memory::Memory(const Functions& vk, VkPhysicalDevice physical_device, VkDevice device, bool fill)
    : vk_(vk), device_(device), fill_(fill) {
  vk_.GetPhysicalDeviceMemoryProperties(physical_device, &properties_);
}

Memory::~Memory() {
  for (const MemoryBlock& block : blocks_) vk_.FreeMemory(device_, block.memory, nullptr);
}

std::uint32_t Memory::find_type(std::uint32_t type_bits, MemoryUse use) const {
  constexpr VkMemoryPropertyFlags kHost =
      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  // Ordered by preference: the first match wins.
  std::vector<VkMemoryPropertyFlags> requests;
  if (use == MemoryUse::device) requests = {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0};
  if (use == MemoryUse::upload) requests = {kHost};
  if (use == MemoryUse::readback) requests = {kHost | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, kHost};
  for (const VkMemoryPropertyFlags request : requests) {
    for (std::uint32_t i = 0; i < properties_.memoryTypeCount; ++i) {
      if ((type_bits >> i & 1) && (properties_.memoryTypes[i].propertyFlags & request) == request) return i;
    }
  }
  throw Error(ErrorCode::resource_limit, "the Vulkan device lacks a required memory type");
}

Memory::MemoryBlock& Memory::add_block(VkDeviceSize size, std::uint32_t type, MemoryUse use, bool tiled) {
  MemoryBlock block;
  block.size = size;
  block.type = type;
  block.tiled = tiled;
  block.for_device = use == MemoryUse::device;
  block.holes[0] = size;
  const VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, size, type};
  const VkMemoryHeap& heap = properties_.memoryHeaps[properties_.memoryTypes[type].heapIndex];
  check(vk_.AllocateMemory(device_, &info, nullptr, &block.memory),
        allocation_text(size, bytes_in_use_, heap).c_str());
  const bool is_visible =
      (properties_.memoryTypes[type].propertyFlags & VK_MEMORY_PROPERTY_HOST_COHERENT_BIT) != 0;
  if (!block.for_device || (fill_ && is_visible)) {
    void* pointer = nullptr;
    const VkResult result = vk_.MapMemory(device_, block.memory, 0, VK_WHOLE_SIZE, 0, &pointer);
    if (result != VK_SUCCESS) vk_.FreeMemory(device_, block.memory, nullptr);
    check(result, "vkMapMemory");
    block.mapped = static_cast<std::byte*>(pointer);
  }
  return blocks_.emplace_back(std::move(block));
}

Memory::Range Memory::allocate(const VkMemoryRequirements& needs, MemoryUse use, bool tiled) {
  const std::lock_guard lock(mutex_);
  const std::uint32_t type = find_type(needs.memoryTypeBits, use);
  const auto range_in = [&](MemoryBlock& block) -> std::optional<Range> {
    const auto offset = take(block.holes, needs.size, needs.alignment);
    if (!offset) return std::nullopt;
    bytes_in_use_ += needs.size;
    const Range range{&block, block.memory, *offset, needs.size,
                      block.for_device ? nullptr : block.mapped + *offset};
    if (block.for_device && block.mapped) fill(range);
    return range;
  };
  if (needs.size < kDedicatedBytes) {
    for (MemoryBlock& block : blocks_) {
      if (block.type != type || block.tiled != tiled || block.for_device != (use == MemoryUse::device))
        continue;
      if (const auto range = range_in(block)) return *range;
    }
  }
  return *range_in(add_block(needs.size < kDedicatedBytes ? kBlockBytes : needs.size, type, use, tiled));
}

/// Other values each time, all of them finite as half floats and as floats.
void Memory::fill(const Range& range) {
  constexpr std::uint32_t kFinite = 0x3c00;
  std::byte* const bytes = range.block->mapped + range.offset;
  std::uint32_t state = ++filled_ * 747796405u;
  for (VkDeviceSize i = 0; i + sizeof state <= range.size; i += sizeof state) {
    state = state * 1664525u + 1013904223u;
    const std::uint32_t word = (state & 0xffff) % kFinite | (state >> 16) % kFinite << 16;
    std::memcpy(bytes + i, &word, sizeof word);
  }
}

void Memory::free(const Range& range) noexcept {
  if (!range.block) return;
  const std::lock_guard lock(mutex_);
  bytes_in_use_ -= range.size;
  MemoryBlock& block = *range.block;
  give(block.holes, range.offset, range.size);
  const bool empty = block.holes.size() == 1 && block.holes.begin()->second == block.size;
  if (!empty || block.size == kBlockBytes) return;  // Shared blocks are retained for reuse.
  vk_.FreeMemory(device_, block.memory, nullptr);
  blocks_.remove_if([&](const MemoryBlock& other) { return &other == &block; });
}

VkDeviceSize Memory::bytes_in_use() const {
  const std::lock_guard lock(mutex_);
  return bytes_in_use_;
}

}  // namespace brume::gpu
