#include "gpu/barriers.hpp"

#include <string>

#include "core/error.hpp"

namespace brume::gpu {
namespace {

// Flags up to this bit are the same in both.
constexpr VkFlags64 kSameFlags = 0x7fffffff;

void add_barriers_before_2(CommandList& list, std::span<const VkBufferMemoryBarrier2> buffers,
                           std::span<const VkImageMemoryBarrier2> images) {
  VkPipelineStageFlags2 before = 0, after = 0;
  const auto converted = [&](const auto& barriers, const auto& memory) {
    std::size_t i = 0;
    for (const auto& barrier : barriers) {
      memory[i++] = barrier_before_2(barrier);
      before |= barrier.srcStageMask;
      after |= barrier.dstStageMask;
    }
  };
  const auto own_buffers = list.room<VkBufferMemoryBarrier>(buffers.size());
  const auto own_images = list.room<VkImageMemoryBarrier>(images.size());
  converted(buffers, own_buffers);
  converted(images, own_images);
  list.add([=, first = stages_before_2(before, true), then = stages_before_2(after, false)](
               const Functions& vk, VkCommandBuffer commands) {
    vk.CmdPipelineBarrier(commands, first, then, 0, 0, nullptr,
                          static_cast<std::uint32_t>(own_buffers.size()), own_buffers.data(),
                          static_cast<std::uint32_t>(own_images.size()), own_images.data());
  });
}

}  // namespace

VkPipelineStageFlags stages_before_2(VkPipelineStageFlags2 stages, bool first) {
  constexpr VkPipelineStageFlags2 kTransfers = VK_PIPELINE_STAGE_2_COPY_BIT |
                                               VK_PIPELINE_STAGE_2_RESOLVE_BIT |
                                               VK_PIPELINE_STAGE_2_BLIT_BIT | VK_PIPELINE_STAGE_2_CLEAR_BIT;
  constexpr VkPipelineStageFlags2 kVertexInputs =
      VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT | VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT;
  BRUME_ASSERT((stages & ~(kSameFlags | kTransfers | kVertexInputs)) == 0, std::to_string(stages));
  auto same = static_cast<VkPipelineStageFlags>(stages & kSameFlags);
  if (stages & kTransfers) same |= VK_PIPELINE_STAGE_TRANSFER_BIT;
  if (stages & kVertexInputs) same |= VK_PIPELINE_STAGE_VERTEX_INPUT_BIT;
  if (same == 0) return first ? VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT : VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT;
  return same;
}

VkAccessFlags access_before_2(VkAccessFlags2 access) {
  constexpr VkAccessFlags2 kReads = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT;
  constexpr VkAccessFlags2 kWrites = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
  BRUME_ASSERT((access & ~(kSameFlags | kReads | kWrites)) == 0, std::to_string(access));
  auto same = static_cast<VkAccessFlags>(access & kSameFlags);
  if (access & kReads) same |= VK_ACCESS_SHADER_READ_BIT;
  if (access & kWrites) same |= VK_ACCESS_SHADER_WRITE_BIT;
  return same;
}

VkBufferMemoryBarrier barrier_before_2(const VkBufferMemoryBarrier2& barrier) {
  return {VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER,
          nullptr,
          access_before_2(barrier.srcAccessMask),
          access_before_2(barrier.dstAccessMask),
          barrier.srcQueueFamilyIndex,
          barrier.dstQueueFamilyIndex,
          barrier.buffer,
          barrier.offset,
          barrier.size};
}

VkImageMemoryBarrier barrier_before_2(const VkImageMemoryBarrier2& barrier) {
  return {VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
          nullptr,
          access_before_2(barrier.srcAccessMask),
          access_before_2(barrier.dstAccessMask),
          barrier.oldLayout,
          barrier.newLayout,
          barrier.srcQueueFamilyIndex,
          barrier.dstQueueFamilyIndex,
          barrier.image,
          barrier.subresourceRange};
}

void add_barriers(const Functions& vk, CommandList& list, std::span<const VkBufferMemoryBarrier2> buffers,
                  std::span<const VkImageMemoryBarrier2> images) {
  if (!vk.CmdPipelineBarrier2) return add_barriers_before_2(list, buffers, images);
  const auto own_buffers = list.kept(buffers);
  const auto own_images = list.kept(images);
  VkDependencyInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  info.bufferMemoryBarrierCount = static_cast<std::uint32_t>(own_buffers.size());
  info.pBufferMemoryBarriers = own_buffers.data();
  info.imageMemoryBarrierCount = static_cast<std::uint32_t>(own_images.size());
  info.pImageMemoryBarriers = own_images.data();
  list.add([=](const Functions& own_vk, VkCommandBuffer commands) {
    own_vk.CmdPipelineBarrier2(commands, &info);
  });
}

}  // namespace brume::gpu
