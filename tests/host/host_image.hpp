// Images of a host, with what Vulkan allows and gpu::Image has not: any format, layers.
#pragma once

#include <bit>
#include <vector>

#include "tests/host/hosted_smoke.hpp"

namespace brume::host {

/// An image of a host, of whose layers Brume sees the views alone.
class HostImage {
 public:
  HostImage(gpu::Context& gpu, VkFormat format, VkImageAspectFlags aspects, VkImageUsageFlags usage,
            glm::uvec2 size = kSize, std::uint32_t layers = 1)
      : gpu_(gpu), aspects_(aspects) {
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {size.x, size.y, 1};
    info.mipLevels = 1;
    info.arrayLayers = layers;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = usage;
    gpu::check(gpu.vk().CreateImage(gpu.device(), &info, nullptr, &handle_), "vkCreateImage");
    VkMemoryRequirements needs;
    gpu.vk().GetImageMemoryRequirements(gpu.device(), handle_, &needs);
    VkMemoryAllocateInfo allocation{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needs.size,
                                    static_cast<std::uint32_t>(std::countr_zero(needs.memoryTypeBits))};
    gpu::check(gpu.vk().AllocateMemory(gpu.device(), &allocation, nullptr, &memory_), "vkAllocateMemory");
    gpu::check(gpu.vk().BindImageMemory(gpu.device(), handle_, memory_, 0), "vkBindImageMemory");
    for (std::uint32_t layer = 0; layer < layers; ++layer) add_view(format, layer);
  }
  ~HostImage() {
    for (const VkImageView view : views_) gpu_.vk().DestroyImageView(gpu_.device(), view, nullptr);
    gpu_.vk().DestroyImage(gpu_.device(), handle_, nullptr);
    gpu_.vk().FreeMemory(gpu_.device(), memory_, nullptr);
  }
  HostImage(const HostImage&) = delete;
  HostImage& operator=(const HostImage&) = delete;

  VkImage handle() const { return handle_; }
  VkImageView view(std::size_t layer = 0) const { return views_[layer]; }
  /// After and before everything.
  void transition(VkCommandBuffer commands, VkImageLayout from, VkImageLayout to) const {
    VkImageMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
    barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.image = handle_;
    barrier.subresourceRange = {aspects_, 0, 1, 0, VK_REMAINING_ARRAY_LAYERS};
    const VkMemoryBarrier all{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, barrier.srcAccessMask,
                              barrier.dstAccessMask};
    gpu_.vk().CmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                                 VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1, &all, 0, nullptr, 1, &barrier);
  }

 private:
  void add_view(VkFormat format, std::uint32_t layer) {
    VkImageViewCreateInfo view{};
    view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    view.image = handle_;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format;
    view.subresourceRange = {aspects_ & ~static_cast<VkImageAspectFlags>(VK_IMAGE_ASPECT_STENCIL_BIT), 0, 1,
                             layer, 1};
    views_.emplace_back();
    gpu::check(gpu_.vk().CreateImageView(gpu_.device(), &view, nullptr, &views_.back()), "vkCreateImageView");
  }

  gpu::Context& gpu_;
  VkImageAspectFlags aspects_;
  VkImage handle_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  std::vector<VkImageView> views_;
};

}  // namespace brume::host
