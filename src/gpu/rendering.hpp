// The begin and the end of draws into attachments: by dynamic rendering, or by render passes where the device
// lacks it.
#pragma once

#include <array>

#include "gpu/command_list.hpp"
#include "gpu/context.hpp"
#include "gpu/render_passes.hpp"

namespace brume::gpu {

/// Attachments, in the layouts of attachments, and the part of them that is drawn.
struct RenderingInfo {
  RenderPassInfo pass;
  std::array<VkImageView, kMostColours + 1> views{};  ///< Colours, then the depth.
  std::uint32_t colour_count = 0;
  VkRect2D area{};
};

/// Adds the command that begins. Clears to 0 what is not loaded.
void add_begin_rendering(Context& context, CommandList& list, const RenderingInfo& rendering);
void add_end_rendering(CommandList& list);

}  // namespace brume::gpu
