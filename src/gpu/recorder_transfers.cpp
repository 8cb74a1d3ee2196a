// The transfers of a recorder: between memory of the CPU, buffers and images.
#include <algorithm>
#include <cstring>

#include "core/error.hpp"
#include "gpu/recorder.hpp"

namespace brume::gpu {
namespace {

constexpr VkDeviceSize kStagingBytes = 8ull << 20;

/// Whether a copy is a part of the commands: a device takes longer to begin a copy from memory of the CPU
/// than to write a few kilobytes.
bool is_inline(const VkBufferCopy& region) {
  constexpr VkDeviceSize kMostBytes = 65536;  // the most that vkCmdUpdateBuffer takes
  return region.size <= kMostBytes && region.size % 4 == 0 && region.dstOffset % 4 == 0;
}

VkImageBlit whole_blit(glm::uvec2 from, glm::uvec2 to) {
  VkImageBlit blit{};
  blit.srcSubresource = blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  blit.srcOffsets[1] = {static_cast<std::int32_t>(from.x), static_cast<std::int32_t>(from.y), 1};
  blit.dstOffsets[1] = {static_cast<std::int32_t>(to.x), static_cast<std::int32_t>(to.y), 1};
  return blit;
}

}  // namespace

Recorder::Staged Recorder::stage_bytes(std::span<const std::byte> bytes) {
  // Offsets of image copies must be multiples of the texel size; 16 covers every format in use.
  constexpr VkDeviceSize kAlignment = 16;
  auto& buffers = slot_.staging_;
  while (slot_.staging_index_ < buffers.size() &&
         slot_.staging_used_ + bytes.size() > buffers[slot_.staging_index_].size()) {
    ++slot_.staging_index_;
    slot_.staging_used_ = 0;
  }
  if (slot_.staging_index_ == buffers.size()) {
    buffers.emplace_back(context_, std::max<VkDeviceSize>(kStagingBytes, bytes.size()),
                         VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::upload);
    slot_.staging_used_ = 0;
  }
  const Staged staged{&buffers[slot_.staging_index_], slot_.staging_used_};
  std::memcpy(staged.buffer->mapped() + staged.offset, bytes.data(), bytes.size());
  slot_.staging_used_ += (bytes.size() + kAlignment - 1) / kAlignment * kAlignment;
  return staged;
}

void Recorder::upload(const Buffer& buffer, VkDeviceSize offset, std::span<const std::byte> bytes) {
  if (bytes.empty()) return;
  BRUME_ASSERT(offset + bytes.size() <= buffer.size(), std::to_string(offset + bytes.size()));
  const Staged staged = stage_bytes(bytes);
  add_transfer(buffer, {staged.buffer->handle(),
                        buffer.handle(),
                        {staged.offset, offset, bytes.size()},
                        staged.buffer->mapped() + staged.offset,
                        0});
}

void Recorder::add_transfer(const Buffer& to, const Transfer& transfer) {
  BRUME_ASSERT(!concurrently_, "a transfer among dispatches");
  // The barriers of all come before the first, so that none may depend on another.
  const auto overlaps = [&](const Transfer& other) {
    const VkBufferCopy& region = transfer.region;
    return other.to == transfer.to && region.dstOffset < other.region.dstOffset + other.region.size &&
           other.region.dstOffset < region.dstOffset + region.size;
  };
  if (std::ranges::any_of(transfers_, overlaps)) flush_transfers();
  add_barrier(to, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
  transfers_.push_back(transfer);
}

void Recorder::flush_transfers() {
  if (transfers_.empty()) return;
  flush_barriers();
  FrameVector<VkBufferCopy> regions(&memory());
  for (std::size_t i = 0; i < transfers_.size(); ++i) {
    const Transfer one = transfers_[i];
    // Fills, small uploads inline, and copies: those between the same two buffers are one command.
    if (!one.from) {
      list_.add([=](const Functions& vk, VkCommandBuffer commands) {
        vk.CmdFillBuffer(commands, one.to, one.region.dstOffset, one.region.size, one.value);
      });
      continue;
    }
    if (is_inline(one.region)) {
      list_.add([=](const Functions& vk, VkCommandBuffer commands) {
        vk.CmdUpdateBuffer(commands, one.to, one.region.dstOffset, one.region.size, one.bytes);
      });
      continue;
    }
    regions.push_back(one.region);
    const bool continues = i + 1 < transfers_.size() && transfers_[i + 1].from == one.from &&
                           transfers_[i + 1].to == one.to && !is_inline(transfers_[i + 1].region);
    if (continues) continue;
    list_.add([one, copied = list_.kept(std::span<const VkBufferCopy>(regions))](const Functions& vk,
                                                                                 VkCommandBuffer commands) {
      vk.CmdCopyBuffer(commands, one.from, one.to, static_cast<std::uint32_t>(copied.size()), copied.data());
    });
    regions.clear();
  }
  transfers_.clear();
}

void Recorder::upload(const Image& image, std::span<const Region> regions) {
  if (regions.empty()) return;
  use(image, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
      VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
  flush_barriers();

  // One copy command per staging buffer.
  FrameVector<VkBufferImageCopy> copies(&memory());
  const Buffer* source = nullptr;
  const auto flush_copies = [&] {
    if (!source || copies.empty()) return;
    list_.add([from = source->handle(), to = image.handle(),
               copied = list_.kept(std::span<const VkBufferImageCopy>(copies))](const Functions& vk,
                                                                                VkCommandBuffer commands) {
      vk.CmdCopyBufferToImage(commands, from, to, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                              static_cast<std::uint32_t>(copied.size()), copied.data());
    });
    copies.clear();
  };
  for (const Region& region : regions) {
    const Staged staged = stage_bytes(region.texels);
    if (staged.buffer != source) flush_copies();
    source = staged.buffer;
    VkBufferImageCopy copy{};
    copy.bufferOffset = staged.offset;
    copy.imageSubresource = {image.aspect(), 0, 0, 1};
    copy.imageOffset = {region.offset.x, region.offset.y, region.offset.z};
    copy.imageExtent = {region.size.x, region.size.y, region.size.z};
    copies.push_back(copy);
  }
  flush_copies();
}

void Recorder::fill(const Buffer& buffer, std::uint32_t value) {
  add_transfer(buffer, {VK_NULL_HANDLE, buffer.handle(), {0, 0, buffer.size() / 4 * 4}, nullptr, value});
}

void Recorder::clear(const Image& image, VkClearColorValue value) {
  use(image, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_GENERAL);
  flush_barriers();
  const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, VK_REMAINING_MIP_LEVELS, 0,
                                    VK_REMAINING_ARRAY_LAYERS};
  list_.add([to = image.handle(), value, all](const Functions& vk, VkCommandBuffer commands) {
    vk.CmdClearColorImage(commands, to, VK_IMAGE_LAYOUT_GENERAL, &value, 1, &all);
  });
}

void Recorder::read_back(const Image& image, const Buffer& buffer) {
  const bool general = image.sampled_layout() == VK_IMAGE_LAYOUT_GENERAL;
  const VkImageLayout layout = general ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
  use(image, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, layout);
  use(buffer, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
  flush_barriers();
  VkBufferImageCopy copy{};
  copy.imageSubresource = {image.aspect(), 0, 0, 1};
  copy.imageExtent = {image.info().size.x, image.info().size.y, image.info().size.z};
  list_.add([from = image.handle(), layout, to = buffer.handle(), copy](const Functions& vk,
                                                                        VkCommandBuffer commands) {
    vk.CmdCopyImageToBuffer(commands, from, layout, to, 1, &copy);
  });
  use(buffer, VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
  flush_barriers();
}

void Recorder::read_back(const Buffer& from, const Buffer& to, VkDeviceSize bytes) {
  use(from, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT);
  use(to, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
  flush_barriers();
  const VkBufferCopy copy{0, 0, bytes};
  list_.add([from = from.handle(), to = to.handle(), copy](const Functions& vk, VkCommandBuffer commands) {
    vk.CmdCopyBuffer(commands, from, to, 1, &copy);
  });
  use(to, VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
  flush_barriers();
}

void Recorder::add_blit(const Image& from, VkImage to, VkImageLayout layout, const VkImageBlit& blit,
                        VkFilter filter) {
  list_.add([from = from.handle(), to, layout, blit, filter](const Functions& vk, VkCommandBuffer commands) {
    vk.CmdBlitImage(commands, from, VK_IMAGE_LAYOUT_GENERAL, to, layout, 1, &blit, filter);
  });
}

void Recorder::blit(const Image& from, const Image& to, VkFilter filter) {
  use(from, VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, VK_IMAGE_LAYOUT_GENERAL);
  use(to, VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_GENERAL);
  flush_barriers();
  const VkImageBlit blit = whole_blit(glm::uvec2(from.info().size), glm::uvec2(to.info().size));
  add_blit(from, to.handle(), VK_IMAGE_LAYOUT_GENERAL, blit, filter);
}

void Recorder::blit(const Image& from, const WindowImage& to) {
  use(from, VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_READ_BIT, VK_IMAGE_LAYOUT_GENERAL);
  const auto change = [&](VkAccessFlags2 before, VkAccessFlags2 after, VkImageLayout old_layout,
                          VkImageLayout new_layout) {
    image_barriers_.push_back({VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                               nullptr,
                               VK_PIPELINE_STAGE_2_BLIT_BIT,
                               before,
                               VK_PIPELINE_STAGE_2_BLIT_BIT,
                               after,
                               old_layout,
                               new_layout,
                               VK_QUEUE_FAMILY_IGNORED,
                               VK_QUEUE_FAMILY_IGNORED,
                               to.handle,
                               {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}});
    flush_barriers();
  };
  change(0, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
  const VkImageBlit blit = whole_blit(glm::uvec2(from.info().size), to.size_px);
  add_blit(from, to.handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, blit, VK_FILTER_NEAREST);
  change(VK_ACCESS_2_TRANSFER_WRITE_BIT, 0, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
         VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
}

void Recorder::make_mip_levels(const Image& image) {
  use(image, VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT,
      VK_IMAGE_LAYOUT_GENERAL);
  flush_barriers();
  auto half = [](std::uint32_t size, std::uint32_t level) {
    return static_cast<std::int32_t>(std::max(1u, size >> level));
  };
  const glm::uvec3 size = image.info().size;
  for (std::uint32_t level = 1; level < image.info().mip_levels; ++level) {
    VkImageBlit blit{};
    blit.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level - 1, 0, 1};
    blit.srcOffsets[1] = {half(size.x, level - 1), half(size.y, level - 1), half(size.z, level - 1)};
    blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 1};
    blit.dstOffsets[1] = {half(size.x, level), half(size.y, level), half(size.z, level)};
    add_blit(image, image.handle(), VK_IMAGE_LAYOUT_GENERAL, blit, VK_FILTER_LINEAR);
    use(image, VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT,
        VK_IMAGE_LAYOUT_GENERAL);
    flush_barriers();
  }
}

}  // namespace brume::gpu
