// Render passes of a device without dynamic rendering.
#pragma once

#include <array>
#include <compare>
#include <map>
#include <mutex>

#include "gpu/functions.hpp"

namespace brume::gpu {

inline constexpr std::size_t kMostColours = 4;

/// Attachments of a render pass of one subpass. They are in the layouts of attachments before and after it.
/// Passes whose formats are equal are compatible.
struct RenderPassInfo {
  std::array<VkFormat, kMostColours> colours{};  ///< VK_FORMAT_UNDEFINED after the last one.
  std::array<VkAttachmentLoadOp, kMostColours> loads{};
  VkFormat depth = VK_FORMAT_UNDEFINED;  ///< VK_FORMAT_UNDEFINED: no depth.
  VkAttachmentLoadOp depth_load = VK_ATTACHMENT_LOAD_OP_LOAD;
  auto operator<=>(const RenderPassInfo&) const = default;
};

/// Makes each render pass once, and keeps it. Any thread may call any function.
class RenderPasses {
 public:
  /// `vk` and the device must outlive it.
  RenderPasses(const Functions& vk, VkDevice device) : vk_(vk), device_(device) {}
  /// The device has completed all that uses the passes.
  ~RenderPasses();
  RenderPasses(const RenderPasses&) = delete;
  RenderPasses& operator=(const RenderPasses&) = delete;

  VkRenderPass find_or_make(const RenderPassInfo& info);

 private:
  const Functions& vk_;
  VkDevice device_;
  std::mutex mutex_;
  std::map<RenderPassInfo, VkRenderPass> passes_;
};

}  // namespace brume::gpu
