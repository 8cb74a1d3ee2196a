#include "gpu/rendering.hpp"

namespace brume::gpu {
namespace {

VkRenderingAttachmentInfo attachment(VkImageView view, VkImageLayout layout, VkAttachmentLoadOp load) {
  VkRenderingAttachmentInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
  info.imageView = view;
  info.imageLayout = layout;
  info.loadOp = load;
  info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  return info;
}

void begin_dynamic(const Functions& vk, VkCommandBuffer commands, const RenderingInfo& rendering) {
  const std::uint32_t count = rendering.colour_count;
  std::array<VkRenderingAttachmentInfo, kMostColours> colours;
  for (std::uint32_t i = 0; i < count; ++i)
    colours[i] =
        attachment(rendering.views[i], VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, rendering.pass.loads[i]);
  const VkRenderingAttachmentInfo depth = attachment(
      rendering.views[count], VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, rendering.pass.depth_load);
  VkRenderingInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
  info.renderArea = rendering.area;
  info.layerCount = 1;
  info.colorAttachmentCount = count;
  info.pColorAttachments = colours.data();
  info.pDepthAttachment = rendering.views[count] ? &depth : nullptr;
  vk.CmdBeginRendering(commands, &info);
}

/// One of this frame, which is destroyed with it: views of a host, and of images that are made again, may
/// have the handles of others before.
VkFramebuffer make_framebuffer(Context& context, const RenderingInfo& rendering, VkRenderPass pass) {
  const std::uint32_t colours = rendering.colour_count;
  VkFramebufferCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
  info.renderPass = pass;
  info.attachmentCount = colours + (rendering.views[colours] ? 1 : 0);
  info.pAttachments = rendering.views.data();
  info.width = static_cast<std::uint32_t>(rendering.area.offset.x) + rendering.area.extent.width;
  info.height = static_cast<std::uint32_t>(rendering.area.offset.y) + rendering.area.extent.height;
  info.layers = 1;
  context.expect_retirement();
  VkFramebuffer framebuffer = VK_NULL_HANDLE;
  check(context.vk().CreateFramebuffer(context.device(), &info, context.vk().allocator, &framebuffer),
        "vkCreateFramebuffer");
  context.retire({.framebuffer = framebuffer});
  return framebuffer;
}

void add_render_pass(Context& context, CommandList& list, const RenderingInfo& rendering) {
  const VkRenderPass pass = context.pipelines().render_passes().find_or_make(rendering.pass);
  const VkFramebuffer framebuffer = make_framebuffer(context, rendering, pass);
  list.add([pass, framebuffer, area = rendering.area](const Functions& vk, VkCommandBuffer commands) {
    const std::array<VkClearValue, kMostColours + 1> clear{};
    VkRenderPassBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
    info.renderPass = pass;
    info.framebuffer = framebuffer;
    info.renderArea = area;
    info.clearValueCount = static_cast<std::uint32_t>(clear.size());
    info.pClearValues = clear.data();
    vk.CmdBeginRenderPass(commands, &info, VK_SUBPASS_CONTENTS_INLINE);
  });
}

}  // namespace

void add_begin_rendering(Context& context, CommandList& list, const RenderingInfo& rendering) {
  if (!context.vk().CmdBeginRendering) return add_render_pass(context, list, rendering);
  list.add(
      [rendering](const Functions& vk, VkCommandBuffer commands) { begin_dynamic(vk, commands, rendering); });
}

void add_end_rendering(CommandList& list) {
  list.add([](const Functions& vk, VkCommandBuffer commands) {
    vk.CmdEndRendering ? vk.CmdEndRendering(commands) : vk.CmdEndRenderPass(commands);
  });
}

}  // namespace brume::gpu
