#include "gpu/render_passes.hpp"

namespace brume::gpu {
namespace {

VkAttachmentDescription description(VkFormat format, VkAttachmentLoadOp load, VkImageLayout layout) {
  VkAttachmentDescription attachment{};
  attachment.format = format;
  attachment.samples = VK_SAMPLE_COUNT_1_BIT;
  attachment.loadOp = load;
  attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  attachment.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  attachment.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
  attachment.initialLayout = attachment.finalLayout = layout;
  return attachment;
}

VkRenderPass make(const Functions& vk, VkDevice device, const RenderPassInfo& wanted) {
  // Attachments: colours, then the depth.
  std::array<VkAttachmentDescription, kMostColours + 1> attachments;
  std::array<VkAttachmentReference, kMostColours> colours;
  std::uint32_t count = 0;
  for (; count < kMostColours && wanted.colours[count] != VK_FORMAT_UNDEFINED; ++count) {
    colours[count] = {count, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    attachments[count] = description(wanted.colours[count], wanted.loads[count], colours[count].layout);
  }
  const VkAttachmentReference depth{count, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
  const bool has_depth = wanted.depth != VK_FORMAT_UNDEFINED;
  if (has_depth) attachments[count] = description(wanted.depth, wanted.depth_load, depth.layout);

  // The pass, of one subpass.
  VkSubpassDescription subpass{};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = count;
  subpass.pColorAttachments = colours.data();
  subpass.pDepthStencilAttachment = has_depth ? &depth : nullptr;
  VkRenderPassCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
  info.attachmentCount = count + (has_depth ? 1 : 0);
  info.pAttachments = attachments.data();
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  VkRenderPass pass = VK_NULL_HANDLE;
  check(vk.CreateRenderPass(device, &info, vk.allocator, &pass), "vkCreateRenderPass");
  return pass;
}

}  // namespace

RenderPasses::~RenderPasses() {
  for (const auto& [info, pass] : passes_) vk_.DestroyRenderPass(device_, pass, vk_.allocator);
}

VkRenderPass RenderPasses::find_or_make(const RenderPassInfo& info) {
  const std::scoped_lock lock(mutex_);
  VkRenderPass& pass = passes_[info];
  if (!pass) pass = make(vk_, device_, info);
  return pass;
}

}  // namespace brume::gpu
