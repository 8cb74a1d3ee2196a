// Barriers of synchronization2 in the terms of Vulkan 1.0.
#include "gpu/barriers.hpp"

#include <gtest/gtest.h>

namespace brume::gpu {
namespace {

TEST(BarriersBefore2, HaveTheStagesAndAccessesThatIncludeTheNewOnes) {
  for (const VkPipelineStageFlags2 transfer :
       {VK_PIPELINE_STAGE_2_COPY_BIT, VK_PIPELINE_STAGE_2_BLIT_BIT, VK_PIPELINE_STAGE_2_CLEAR_BIT,
        VK_PIPELINE_STAGE_2_RESOLVE_BIT, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT})
    EXPECT_EQ(stages_before_2(transfer | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, true),
              VkPipelineStageFlags{VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT});
  EXPECT_EQ(stages_before_2(VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, false), VK_PIPELINE_STAGE_VERTEX_INPUT_BIT);
  EXPECT_EQ(stages_before_2(0, true), VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT);
  EXPECT_EQ(stages_before_2(0, false), VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT);
  EXPECT_EQ(access_before_2(VK_ACCESS_2_SHADER_SAMPLED_READ_BIT), VK_ACCESS_SHADER_READ_BIT);
  EXPECT_EQ(access_before_2(VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
                            VK_ACCESS_2_HOST_READ_BIT),
            VkAccessFlags{VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_HOST_READ_BIT});
}

TEST(BarriersBefore2, KeepTheRest) {
  VkImageMemoryBarrier2 barrier{};
  barrier.srcAccessMask = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_2_TRANSFER_READ_BIT;
  barrier.oldLayout = VK_IMAGE_LAYOUT_GENERAL;
  barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
  barrier.srcQueueFamilyIndex = 1;
  barrier.dstQueueFamilyIndex = 2;
  barrier.subresourceRange = {VK_IMAGE_ASPECT_DEPTH_BIT, 1, 2, 3, 4};
  const VkImageMemoryBarrier own = barrier_before_2(barrier);
  EXPECT_EQ(own.sType, VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER);
  EXPECT_EQ(own.srcAccessMask, VK_ACCESS_SHADER_WRITE_BIT);
  EXPECT_EQ(own.dstAccessMask, VK_ACCESS_TRANSFER_READ_BIT);
  EXPECT_EQ(own.oldLayout, barrier.oldLayout);
  EXPECT_EQ(own.newLayout, barrier.newLayout);
  EXPECT_EQ(own.srcQueueFamilyIndex, 1u);
  EXPECT_EQ(own.dstQueueFamilyIndex, 2u);
  EXPECT_EQ(own.subresourceRange.layerCount, 4u);
}

}  // namespace
}  // namespace brume::gpu
