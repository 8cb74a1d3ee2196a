// A headset: two off-centre views in the layers of array images, over many frames.
#include <array>

#include "gpu/read_back.hpp"
#include "tests/host/host_image.hpp"
#include "tests/host/hosted_pair.hpp"
#include "tests/host/yard.hpp"

namespace brume::host {
namespace {

constexpr std::uint32_t kFrames = 90;
constexpr glm::uvec2 kEye{24, 20};
constexpr VkFormat kFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
/// Reverse depths of the left and of the right eye's surfaces: none, and a wall at 4 m.
constexpr std::array kDepths{0.0f, 0.1f / 4};

/// Depth and picture of one eye, or of both in two layers.
struct EyeImages {
  EyeImages(gpu::Context& context, std::uint32_t layers)
      : gpu(context),
        depth(gpu, VK_FORMAT_R32_SFLOAT, VK_IMAGE_ASPECT_COLOR_BIT,
              VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, kEye, layers),
        picture(gpu, kFormat, VK_IMAGE_ASPECT_COLOR_BIT,
                VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                    VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                kEye, layers) {}

  /// An empty picture, and a depth for each layer from `first_eye` on.
  void clear(VkCommandBuffer commands, std::uint32_t layers, std::uint32_t first_eye) const {
    constexpr VkImageLayout kTarget = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    for (const HostImage* image : {&depth, &picture})
      image->transition(commands, VK_IMAGE_LAYOUT_UNDEFINED, kTarget);
    for (std::uint32_t layer = 0; layer < layers; ++layer) {
      const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, layer, 1};
      const VkClearColorValue far{{kDepths[first_eye + layer], 0, 0, 0}}, black{};
      gpu.vk().CmdClearColorImage(commands, depth.handle(), kTarget, &far, 1, &range);
      gpu.vk().CmdClearColorImage(commands, picture.handle(), kTarget, &black, 1, &range);
    }
    depth.transition(commands, kTarget, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    picture.transition(commands, kTarget, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
  }
  void show(brume_frame_params& params, std::uint32_t layer) const {
    params.depth.view = depth.view(layer);
    params.picture = {picture.view(layer), kFormat, 1};
  }
  /// Ends the frame.
  gpu::Buffer read(VkCommandBuffer commands, std::uint32_t layers) const {
    gpu::Buffer copy = gpu::readback_buffer(gpu, std::uint64_t{8} * kEye.x * kEye.y * layers);
    picture.transition(commands, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                       VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, layers};
    region.imageExtent = {kEye.x, kEye.y, 1};
    gpu.vk().CmdCopyImageToBuffer(commands, picture.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                  copy.handle(), 1, &region);
    return copy;
  }

  gpu::Context& gpu;
  HostImage depth, picture;
};

class HeadsetTest : public YardTest {
 protected:
  HeadsetTest() : YardTest(gpu::kUsualHost, kEye) {}
  ~HeadsetTest() override {
    host_.wait();
    for (brume_renderer* renderer : alone_) EXPECT_OK(brume_renderer_destroy(renderer));
  }
  /// What an eye sees: the head turns and walks.
  static void look(brume_frame_params& params, std::uint32_t eye, std::uint32_t frame) {
    const float turn = 0.004f * static_cast<float>(frame), side = eye == 0 ? -0.032f : 0.032f;
    params.camera.forward = {std::cos(turn), -0.1f, std::sin(turn)};
    params.camera.position = {1.5f + 0.01f * static_cast<float>(frame) - side * std::sin(turn), 1.6f,
                              3 + side * std::cos(turn)};
    params.frustum = eye == 0 ? brume_frustum{-1.1f, 0.8f, -0.9f, 1} : brume_frustum{-0.8f, 1.1f, -0.9f, 1};
  }

  std::array<brume_renderer*, 2> alone_{};  ///< A renderer for each eye.
};

// Each eye has the picture of a renderer of its own, in images of its own.
TEST_F(HeadsetTest, TwoEyesInTheLayersOfAnArray) {
  make_smoky();
  std::swap(renderer_, alone_[0]);
  ASSERT_OK(create_renderer(1));
  std::swap(renderer_, alone_[1]);
  ASSERT_OK(create_renderer(1));
  const EyeImages both(gpu_, 2), left(gpu_, 1), right(gpu_, 1);
  std::array<gpu::Buffer, 3> copies;
  for (std::uint32_t i = 0; i < kFrames; ++i)
    host_.frame([&](VkCommandBuffer commands, std::uint64_t number, std::uint64_t completed) {
      both.clear(commands, 2, 0);
      left.clear(commands, 1, 0);
      right.clear(commands, 1, 1);
      brume_frame_params params = brume_frame_defaults();
      params.commands = commands;
      params.frame_number = number;
      params.completed_frame = completed;
      params.depth = {VK_NULL_HANDLE, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, 0.1f, INFINITY, 1};
      params.seconds = 2.5;
      params.jitter_index = i;
      params.continues_previous = i > 0;
      std::array<brume_frame_params, 2> eyes{params, params};
      for (std::uint32_t eye = 0; eye < 2; ++eye) {
        look(eyes[eye], eye, i);
        (eye == 0 ? left : right).show(eyes[eye], 0);
        ASSERT_OK(brume_renderer_record(alone_[eye], field_, &eyes[eye]));
        both.show(eyes[eye], eye);
        eyes[eye].view = eye;
      }
      const brume_frame_params* const views[] = {&eyes[0], &eyes[1]};
      ASSERT_OK(brume_renderer_record_views(renderer_, field_, views, 2));
      if (i + 1 == kFrames)
        copies = {both.read(commands, 2), left.read(commands, 1), right.read(commands, 1)};
    });
  host_.wait();
  const Pixels drawn = pixels_of(copies[0]), of_left = pixels_of(copies[1]), of_right = pixels_of(copies[2]);
  double most = 0, brightest = 0, eyes_apart = 0;
  for (std::size_t i = 0; i < of_left.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      most = std::max({most, std::abs(drawn[i][c] - of_left[i][c]),
                       std::abs(drawn[of_left.size() + i][c] - of_right[i][c])});
      brightest = std::max(brightest, of_left[i][c]);
      eyes_apart = std::max(eyes_apart, std::abs(of_left[i][c] - of_right[i][c]));
    }
  EXPECT_LE(most, 1 / 255.0);
  EXPECT_GT(brightest, 0.02) << "smoke is in view";
  EXPECT_GT(eyes_apart, 2 / 255.0) << "each eye has its own picture";
}

}  // namespace
}  // namespace brume::host
