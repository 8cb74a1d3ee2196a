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

using Holes = std::vector<Memory::MemoryBlock::Hole>;

/// Allocates an aligned range from the first hole that fits it; there is room for one more hole.
std::optional<VkDeviceSize> take(Holes& holes, VkDeviceSize size, VkDeviceSize alignment) {
  for (auto hole = holes.begin(); hole != holes.end(); ++hole) {
    const auto [begin, length] = *hole;
    const VkDeviceSize offset = align_up(begin, alignment), end = offset + size;
    if (end > begin + length) continue;
    const Memory::MemoryBlock::Hole before{begin, offset - begin}, after{end, begin + length - end};
    if (before.size > 0 && after.size > 0) {
      *hole = before;
      holes.insert(hole + 1, after);
    } else if (before.size > 0 || after.size > 0) {
      *hole = before.size > 0 ? before : after;
    } else {
      holes.erase(hole);
    }
    return offset;
  }
  return std::nullopt;
}

/// Frees a range, merging it with adjacent holes; there is room for one more hole.
void give(Holes& holes, VkDeviceSize offset, VkDeviceSize size) noexcept {
  const auto next = std::ranges::lower_bound(holes, offset, {}, &Memory::MemoryBlock::Hole::offset);
  const bool joins_next = next != holes.end() && offset + size == next->offset;
  const bool joins_previous =
      next != holes.begin() && std::prev(next)->offset + std::prev(next)->size == offset;
  if (joins_previous) {
    std::prev(next)->size += size;
    if (!joins_next) return;
    std::prev(next)->size += next->size;
    holes.erase(next);
  } else if (joins_next) {
    *next = {offset, size + next->size};
  } else {
    holes.insert(next, {offset, size});
  }
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

Memory::Memory(const Functions& vk, VkPhysicalDevice physical_device, VkDevice device,
               const MemoryOptions& options)
    : vk_(vk), device_(device), options_(options) {
  vk_.GetPhysicalDeviceMemoryProperties(physical_device, &properties_);
}

Memory::~Memory() {
  for (const MemoryBlock& block : blocks_) free_block(block);
}

VkResult Memory::allocate_block(const VkMemoryAllocateInfo& info, VkDeviceMemory& memory) const {
  const MemoryCallbacks& host = options_.callbacks;
  return host.allocate ? host.allocate(host.user, &info, &memory)
                       : vk_.AllocateMemory(device_, &info, vk_.allocator, &memory);
}

void Memory::free_block(const MemoryBlock& block) const noexcept {
  const MemoryCallbacks& host = options_.callbacks;
  if (host.free)
    host.free(host.user, block.memory, block.size);
  else
    vk_.FreeMemory(device_, block.memory, vk_.allocator);
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
  MemoryBlock& block = blocks_.emplace_back();
  try {
    block.size = size;
    block.type = type;
    block.tiled = tiled;
    block.for_device = use == MemoryUse::device;
    // Room for one range, so that to free it cannot fail.
    block.holes.reserve(2);
    block.retired.reserve(1);
    block.holes.push_back({0, size});
    const VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, size, type};
    const VkMemoryHeap& heap = properties_.memoryHeaps[properties_.memoryTypes[type].heapIndex];
    const VkResult allocated = allocate_block(info, block.memory);
    if (allocated != VK_SUCCESS) check(allocated, allocation_text(size, bytes_in_use_, heap).c_str());
    const bool is_visible =
        (properties_.memoryTypes[type].propertyFlags & VK_MEMORY_PROPERTY_HOST_COHERENT_BIT) != 0;
    if (!block.for_device || (options_.fill && is_visible)) {
      void* pointer = nullptr;
      const VkResult result = vk_.MapMemory(device_, block.memory, 0, VK_WHOLE_SIZE, 0, &pointer);
      if (result != VK_SUCCESS) free_block(block);
      check(result, "vkMapMemory");
      block.mapped = static_cast<std::byte*>(pointer);
    }
  } catch (...) {
    blocks_.pop_back();
    throw;
  }
  allocated_bytes_ += size;
  return block;
}

Memory::Range Memory::allocate(const VkMemoryRequirements& needs, MemoryUse use, bool tiled) {
  const std::lock_guard lock(mutex_);
  const std::uint32_t type = find_type(needs.memoryTypeBits, use);
  if (use == MemoryUse::device && unlimited_ == 0 &&
      (device_bytes_ > limit_ || needs.size > limit_ - device_bytes_))
    throw Error(ErrorCode::resource_limit,
                std::to_string(needs.size) + " bytes besides the " + std::to_string(device_bytes_) +
                    " in use are more than the host's limit of " + std::to_string(limit_));

  const auto range_in = [&](MemoryBlock& block) -> std::optional<Range> {
    // Room for what freeing adds, so that it cannot fail.
    block.holes.reserve(block.ranges + 2);
    block.retired.reserve(block.ranges + 1);
    const auto offset = take(block.holes, needs.size, needs.alignment);
    if (!offset) return std::nullopt;
    ++block.ranges;
    bytes_in_use_ += needs.size;
    if (block.for_device) device_bytes_ += needs.size;
    const Range range{&block, block.memory, *offset, needs.size,
                      block.for_device ? nullptr : block.mapped + *offset};
    if (block.for_device && block.mapped) fill(range);
    return range;
  };

  // The first block with a hole, else a new one; a large range has a block of its own.
  if (needs.size < options_.dedicated_bytes) {
    for (MemoryBlock& block : blocks_) {
      if (block.type != type || block.tiled != tiled || block.for_device != (use == MemoryUse::device))
        continue;
      if (const auto range = range_in(block)) return *range;
    }
  }
  return *range_in(
      add_block(needs.size < options_.dedicated_bytes ? options_.block_bytes : needs.size, type, use, tiled));
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
  MemoryBlock& block = *range.block;
  bytes_in_use_ -= range.size;
  if (block.for_device && std::erase(block.retired, range.offset) == 0) device_bytes_ -= range.size;
  --block.ranges;
  give(block.holes, range.offset, range.size);
  if (!block.is_empty()) return;
  // One shared block of a kind is retained for reuse.
  const auto is_spare = [&](const MemoryBlock& other) {
    return &other != &block && other.is_empty() && other.type == block.type && other.tiled == block.tiled &&
           other.for_device == block.for_device;
  };
  if (block.size == options_.block_bytes && std::none_of(blocks_.begin(), blocks_.end(), is_spare)) return;
  allocated_bytes_ -= block.size;
  free_block(block);
  blocks_.remove_if([&](const MemoryBlock& other) { return &other == &block; });
}

void Memory::retire(const Range& range) noexcept {
  if (!range.block || !range.block->for_device) return;
  const std::lock_guard lock(mutex_);
  std::vector<VkDeviceSize>& retired = range.block->retired;
  if (std::ranges::find(retired, range.offset) != retired.end()) return;
  retired.push_back(range.offset);
  device_bytes_ -= range.size;
}

VkDeviceSize Memory::bytes_in_use() const {
  const std::lock_guard lock(mutex_);
  return bytes_in_use_;
}

VkDeviceSize Memory::device_bytes() const {
  const std::lock_guard lock(mutex_);
  return device_bytes_;
}

VkDeviceSize Memory::allocated_bytes() const {
  const std::lock_guard lock(mutex_);
  return allocated_bytes_;
}

void Memory::set_limit(VkDeviceSize bytes) {
  const std::lock_guard lock(mutex_);
  limit_ = bytes;
}

VkDeviceSize Memory::limit() const {
  const std::lock_guard lock(mutex_);
  return limit_;
}

}  // namespace brume::gpu
