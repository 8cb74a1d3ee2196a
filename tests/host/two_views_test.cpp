// What the second view of a frame waits for.
#include <array>

#include "tests/host/yard.hpp"

namespace brume::host {
namespace {

/// The stages that barriers wait for before the first dispatch of a view, the import of its depth.
struct WaitedFor {
  static inline VkPipelineStageFlags2 stages = 0;
  static inline bool has_dispatched = false;
  static void begin() {
    stages = 0;
    has_dispatched = false;
  }
  static void call(PFN_vkCmdPipelineBarrier2 real, VkCommandBuffer commands, const VkDependencyInfo* info) {
    for (std::uint32_t i = 0; i < info->imageMemoryBarrierCount && !has_dispatched; ++i)
      stages |= info->pImageMemoryBarriers[i].srcStageMask;
    for (std::uint32_t i = 0; i < info->bufferMemoryBarrierCount && !has_dispatched; ++i)
      stages |= info->pBufferMemoryBarriers[i].srcStageMask;
    real(commands, info);
  }
  static void call(PFN_vkCmdDispatch real, VkCommandBuffer commands, std::uint32_t x, std::uint32_t y,
                   std::uint32_t z) {
    has_dispatched = true;
    real(commands, x, y, z);
  }
};

class TwoViewsTest : public YardTest {
 protected:
  TwoViewsTest() : YardTest(gpu::HostKind::validated) {
    replacements_.push_back(BRUME_INTERPOSED(WaitedFor, CmdPipelineBarrier2));
    replacements_.push_back(BRUME_INTERPOSED(WaitedFor, CmdDispatch));
  }
  ~TwoViewsTest() override { host_.wait(); }
};

// From the second frame on: the first one draws shadow maps.
TEST_F(TwoViewsTest, DepthIsImportedWithoutAWaitForPictures) {
  make_smoky();
  std::array<gpu::Image, 2> pictures;
  for (gpu::Image& picture : pictures)
    picture = gpu::Image(gpu_, {.format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                .size = {kSize, 1},
                                .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT});
  host_.frame([&](VkCommandBuffer commands, std::uint64_t number, std::uint64_t completed) {
    recording_.begin(commands, number, completed);
    for (const gpu::Image& picture : pictures) {
      gpu::Recorder::Attachments attachments;
      attachments.colours = {&picture};
      recording_.recorder().begin_rendering(attachments, kSize);
      recording_.recorder().end_rendering();
    }
    recording_.end();
  });
  for (int i = 0; i < 3; ++i) {
    host_.wait();  // each frame draws over the picture of the one before
    draw({1.5f, 1.6f, 3}, {1, -0.1f, 0.1f}, 2.5, [&](brume_frame_params& params) {
      for (params.view = 0; params.view < 2; ++params.view) {
        params.picture = {pictures[params.view].view(), VK_FORMAT_R16G16B16A16_SFLOAT, 1};
        WaitedFor::begin();
        ASSERT_OK(brume_renderer_record(renderer_, field_, &params));
        EXPECT_TRUE(WaitedFor::has_dispatched);
        const VkPipelineStageFlags2 graphics = WaitedFor::stages & ~(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT |
                                                                     VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT |
                                                                     VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT);
        EXPECT_TRUE(i == 0 || graphics == 0) << "view " << params.view << ": " << graphics;
      }
    });
  }
  host_.wait();
}

}  // namespace
}  // namespace brume::host
