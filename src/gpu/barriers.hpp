// Barriers, in the terms of Vulkan 1.0 for devices without synchronization2: flags have the same bits there,
// or are parts of others (Vulkan specification, VkPipelineStageFlagBits2 and VkAccessFlagBits2).
#pragma once

#include <span>

#include "gpu/command_list.hpp"
#include "gpu/functions.hpp"

namespace brume::gpu {

/// The stages that include these. No stage: the one before all others (`first`), or the one after them.
VkPipelineStageFlags stages_before_2(VkPipelineStageFlags2 stages, bool first);
/// The accesses that include these.
VkAccessFlags access_before_2(VkAccessFlags2 access);
VkBufferMemoryBarrier barrier_before_2(const VkBufferMemoryBarrier2& barrier);
VkImageMemoryBarrier barrier_before_2(const VkImageMemoryBarrier2& barrier);

/// Adds one command with all of the barriers. Without synchronization2 each waits for the stages of all.
void add_barriers(const Functions& vk, CommandList& list, std::span<const VkBufferMemoryBarrier2> buffers,
                  std::span<const VkImageMemoryBarrier2> images);

}  // namespace brume::gpu
