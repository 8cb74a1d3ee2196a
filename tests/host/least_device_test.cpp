// A device of Vulkan 1.2 with the required feature alone draws the same frames, and so does Godot's.
#include "tests/host/hosted_pair.hpp"

namespace brume::host {
namespace {

class LeastDeviceTest : public HostedPair {
 protected:
  /// Two frames, all passes of the renderer and of the interface, on a device.
  std::vector<Texels> frames(gpu::HostKind kind) {
    kind_ = kind;
    reads_radiance_ = reads_shadows_ = true;
    change_params_ = [](brume_frame_params& params) {
      params.shadow_light_count = 1;
      params.bounces = 1;
    };
    make_sides(2, 1);
    EXPECT_EQ(gpu_->vk().CmdBeginRendering == nullptr, kind != gpu::HostKind::validated);
    EXPECT_EQ(gpu_->vk().CmdPipelineBarrier2 == nullptr, kind != gpu::HostKind::validated);
    draw_both(2, 1);
    draw_both(5.25, 1);
    host_->wait();
    std::vector<Texels> drawn;
    for (const std::deque<gpu::Buffer>* each : {&copies_, &radiances_, &shadows_})
      for (const gpu::Buffer& buffer : *each) drawn.push_back(texels_of(buffer));
    TearDown();
    host_.reset();
    return drawn;
  }
};

TEST_F(LeastDeviceTest, DrawsTheSameFrames) {
  const std::vector<Texels> usual = frames(gpu::HostKind::validated), least = frames(gpu::HostKind::least),
                            godot = frames(gpu::HostKind::godot);
  ASSERT_EQ(usual.size(), 8u);
  EXPECT_NE(usual[0], usual[2]);
  EXPECT_EQ(least, usual);
  EXPECT_EQ(godot, usual);
}

}  // namespace
}  // namespace brume::host
