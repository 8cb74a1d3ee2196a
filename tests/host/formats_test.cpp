// Depth and pictures of a host in the formats that engines use, planes of depth, and secondary command
// buffers.
#include <algorithm>
#include <array>
#include <cstring>
#include <glm/gtc/packing.hpp>

#include "tests/host/host_image.hpp"
#include "tests/host/hosted_pair.hpp"
#include "tests/host/yard.hpp"

namespace brume::host {
namespace {

constexpr VkImageAspectFlags kDepth = VK_IMAGE_ASPECT_DEPTH_BIT,
                             kDepthStencil = VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT,
                             kColour = VK_IMAGE_ASPECT_COLOR_BIT;

struct Planes {
  float near_plane = 0.1f, far_plane = INFINITY;
  bool reversed = true;
};

class FormatsTest : public YardTest {
 protected:
  void SetUp() override {
    is_temporal_ = false;
    make_smoky();
  }
  ~FormatsTest() override { host_.wait(); }

  /// Depths of a wall that leans, and none in the upper rows; in steps that 16 bits have where `planes` are
  /// the usual ones.
  static std::vector<float> depths(const Planes& planes) {
    std::vector<float> depths;
    for (std::uint32_t y = 0; y < kSize.y; ++y)
      for (std::uint32_t x = 0; x < kSize.x; ++x) {
        const double step = std::round(65535 * 0.1 / (2 + 0.1 * x + 0.03 * y)), z = 0.1 * 65535 / step;
        const double n = double{planes.near_plane}, f = double{planes.far_plane};
        const double forward = std::isinf(f) ? 1 - n / z : f * (z - n) / (z * (f - n));
        const double d = y < 6 ? 1 : forward;
        depths.push_back(static_cast<float>(planes.reversed ? 1 - d : d));
      }
    return depths;
  }
  /// Texels of a format.
  static std::vector<std::byte> encoded(const std::vector<float>& depths, VkFormat format) {
    std::vector<std::byte> bytes;
    const auto add = [&](auto number) {
      const auto of_number = std::as_bytes(std::span(&number, 1));
      bytes.insert(bytes.end(), of_number.begin(), of_number.end());
    };
    for (const float d : depths) {
      const double exact = double{d};
      if (format == VK_FORMAT_D16_UNORM)
        add(static_cast<std::uint16_t>(std::lround(exact * 0xffff)));
      else if (format == VK_FORMAT_X8_D24_UNORM_PACK32 || format == VK_FORMAT_D24_UNORM_S8_UINT)
        add(static_cast<std::uint32_t>(std::lround(exact * 0xffffff)));
      else
        add(d);
    }
    return bytes;
  }
  bool has_format(VkFormat format, VkFormatFeatureFlags needs) const {
    VkFormatProperties properties;
    gpu_.vk().GetPhysicalDeviceFormatProperties(host_.device().physical_device, format, &properties);
    return (properties.optimalTilingFeatures & needs) == needs;
  }
  /// The smoke over a depth that is uploaded; `record` records the frame.
  Pixels draw_smoke(VkFormat format, VkImageAspectFlags aspects, const Planes& planes,
                    const std::function<void(VkCommandBuffer, brume_frame_params&)>& record) {
    const std::vector<std::byte> texels = encoded(depths(planes), format);
    const gpu::Buffer staging(gpu_, texels.size(),
                              VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT),
        copy = readback_buffer(gpu_);
    const VkImageUsageFlags drawn = aspects & kDepth ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT : 0;
    const HostImage depth(gpu_, format, aspects,
                          drawn | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    host_.frame([&](VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed) {
      recording_.begin(commands, frame, completed);
      recording_.recorder().upload(staging, 0, texels);
      recording_.end();
      depth.transition(commands, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
      VkBufferImageCopy region{};
      region.imageSubresource = {aspects & kDepth ? kDepth : kColour, 0, 0, 1};
      region.imageExtent = {kSize.x, kSize.y, 1};
      gpu_.vk().CmdCopyBufferToImage(commands, staging.handle(), depth.handle(),
                                     VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
      const VkImageLayout layout = aspects & kDepth ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL
                                                    : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
      depth.transition(commands, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, layout);
      brume_frame_params params = brume_frame_defaults();
      params.commands = commands;
      params.frame_number = frame;
      params.completed_frame = completed;
      params.camera.position = {1.5f, 1.6f, 3};
      params.camera.forward = {1, -0.1f, 0.1f};
      params.depth = {depth.view(), layout, planes.near_plane, planes.far_plane, planes.reversed};
      params.seconds = 2.5;
      record(commands, params);
      VkImage image = VK_NULL_HANDLE;
      ASSERT_OK(brume_renderer_smoke(renderer_, &image, nullptr));
      host_.copy(commands, image, {kSize.x, kSize.y}, copy.handle());
    });
    host_.wait();
    return pixels_of(copy);
  }
  Pixels draw_smoke(VkFormat format, VkImageAspectFlags aspects, const Planes& planes = {}) {
    return draw_smoke(format, aspects, planes, [&](VkCommandBuffer, const brume_frame_params& params) {
      ASSERT_OK(brume_renderer_record(renderer_, field_, &params));
    });
  }
  static double most_apart(const Pixels& a, const Pixels& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
      for (int c = 0; c < 4; ++c) most = std::max(most, std::abs(a[i][c] - b[i][c]));
    return most;
  }
};

TEST_F(FormatsTest, EveryFormatOfDepthGivesOnePicture) {
  const Pixels expected = draw_smoke(VK_FORMAT_R32_SFLOAT, kColour);
  EXPECT_GT(std::ranges::count_if(expected, [](const glm::dvec4& p) { return p.a < 0.5; }), 100);
  int formats = 0;
  for (const auto& [format, aspects] : {std::pair{VK_FORMAT_D32_SFLOAT, kDepth},
                                        {VK_FORMAT_D16_UNORM, kDepth},
                                        {VK_FORMAT_X8_D24_UNORM_PACK32, kDepth},
                                        {VK_FORMAT_D32_SFLOAT_S8_UINT, kDepthStencil},
                                        {VK_FORMAT_D24_UNORM_S8_UINT, kDepthStencil}}) {
    if (!has_format(format, VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT |
                                VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT |
                                VK_FORMAT_FEATURE_TRANSFER_DST_BIT))
      continue;
    EXPECT_LT(most_apart(draw_smoke(format, aspects), expected), 1 / 255.0) << "format " << format;
    ++formats;
  }
  EXPECT_GE(formats, 1) << "Vulkan requires D16 to be sampled and drawn";
}

TEST_F(FormatsTest, EveryProjectionOfDepthGivesOnePicture) {
  const Pixels expected = draw_smoke(VK_FORMAT_R32_SFLOAT, kColour);
  for (const Planes& planes : {Planes{0.1f, INFINITY, false}, Planes{0.1f, 100, true},
                               Planes{0.1f, 100, false}, Planes{0.5f, 40, true}, Planes{1, INFINITY, true}})
    EXPECT_LT(most_apart(draw_smoke(VK_FORMAT_R32_SFLOAT, kColour, planes), expected), 1 / 255.0)
        << planes.near_plane << " to " << planes.far_plane << (planes.reversed ? " reversed" : "");
}

/// A format of pictures, and how many bits its numbers have: of a fraction, or behind a leading one.
struct PictureFormat {
  VkFormat format;
  bool is_float;
  glm::ivec3 bits;
  glm::dvec3 (*decode)(const std::byte* texel);
};

template <typename Texel>
Texel texel_at(const std::byte* bytes) {
  Texel texel;
  std::memcpy(&texel, bytes, sizeof texel);
  return texel;
}

const std::array kPictureFormats{
    PictureFormat{
        VK_FORMAT_R16G16B16A16_SFLOAT, true, glm::ivec3(10),
        [](const std::byte* t) { return glm::dvec3(glm::unpackHalf4x16(texel_at<std::uint64_t>(t))); }},
    PictureFormat{
        VK_FORMAT_R8G8B8A8_UNORM, false, glm::ivec3(8),
        [](const std::byte* t) { return glm::dvec3(glm::unpackUnorm4x8(texel_at<std::uint32_t>(t))); }},
    PictureFormat{
        VK_FORMAT_A2B10G10R10_UNORM_PACK32, false, glm::ivec3(10),
        [](const std::byte* t) { return glm::dvec3(glm::unpackUnorm3x10_1x2(texel_at<std::uint32_t>(t))); }},
    PictureFormat{VK_FORMAT_B10G11R11_UFLOAT_PACK32, true, {6, 6, 5}, [](const std::byte* t) {
                    return glm::dvec3(glm::unpackF2x11_1x10(texel_at<std::uint32_t>(t)));
                  }}};

TEST_F(FormatsTest, EveryFormatOfPicturesGetsTheSmoke) {
  constexpr glm::dvec3 kBefore(0.5, 0.25, 0.125);
  int formats = 0;
  for (const PictureFormat& wanted : kPictureFormats) {
    if (!has_format(wanted.format, VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT)) continue;
    ++formats;
    const HostImage picture(gpu_, wanted.format, kColour,
                            VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    const std::size_t texel_bytes = wanted.format == VK_FORMAT_R16G16B16A16_SFLOAT ? 8 : 4;
    const gpu::Buffer copy = gpu::readback_buffer(gpu_, texel_bytes * kSize.x * kSize.y);
    const auto record = [&](VkCommandBuffer commands, brume_frame_params& params) {
      const gpu::Functions& vk = gpu_.vk();
      const VkClearColorValue before{{float(kBefore.r), float(kBefore.g), float(kBefore.b), 1}};
      const VkImageSubresourceRange all{kColour, 0, 1, 0, 1};
      picture.transition(commands, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
      vk.CmdClearColorImage(commands, picture.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &before, 1,
                            &all);
      picture.transition(commands, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                         VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
      params.picture = {picture.view(), wanted.format, 1};
      ASSERT_OK(brume_renderer_record(renderer_, field_, &params));
      picture.transition(commands, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL);
      host_.copy(commands, picture.handle(), {kSize.x, kSize.y}, copy.handle());
    };
    const Pixels smoke = draw_smoke(VK_FORMAT_R32_SFLOAT, kColour, {}, record);

    // A step of the format for the background, one for the result, and half floats of the smoke.
    const auto texels = gpu::values_of<std::byte>(copy);
    double changed = 0;
    for (std::size_t i = 0; i < smoke.size(); ++i) {
      const glm::dvec3 got = wanted.decode(&texels[i * texel_bytes]);
      for (int c = 0; c < 3; ++c) {
        const double expected = smoke[i][c] + smoke[i].a * kBefore[c], step = std::exp2(-wanted.bits[c]);
        const double most = wanted.is_float ? 2 * step * expected : 2 * step;
        ASSERT_NEAR(got[c], wanted.is_float ? expected : std::min(expected, 1.0), most + expected / 1024)
            << "format " << wanted.format << " pixel " << i << " channel " << c;
        changed = std::max(changed, std::abs(got[c] - kBefore[c]));
      }
    }
    EXPECT_GT(changed, 0.1);
  }
  EXPECT_GE(formats, 3) << "Vulkan leaves B10G11R11 alone open";
}

TEST_F(FormatsTest, SecondaryCommandBuffersGiveTheSame) {
  const gpu::Functions& vk = gpu_.vk();
  const VkCommandPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, 0, 0};
  VkCommandPool pool = VK_NULL_HANDLE;
  gpu::check(vk.CreateCommandPool(gpu_.device(), &pool_info, nullptr, &pool), "vkCreateCommandPool");
  const VkCommandBufferAllocateInfo buffer_info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool,
                                                VK_COMMAND_BUFFER_LEVEL_SECONDARY, 1};
  VkCommandBuffer secondary = VK_NULL_HANDLE;
  gpu::check(vk.AllocateCommandBuffers(gpu_.device(), &buffer_info, &secondary), "vkAllocateCommandBuffers");
  const auto execute =
      reinterpret_cast<PFN_vkCmdExecuteCommands>(vk.GetDeviceProcAddr(gpu_.device(), "vkCmdExecuteCommands"));
  const Pixels primary = draw_smoke(VK_FORMAT_R32_SFLOAT, kColour);
  const Pixels drawn = draw_smoke(
      VK_FORMAT_R32_SFLOAT, kColour, {}, [&](VkCommandBuffer commands, brume_frame_params& params) {
        VkCommandBufferInheritanceInfo inherited{};
        inherited.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_INFO;
        const VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr,
                                             VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT, &inherited};
        gpu::check(vk.BeginCommandBuffer(secondary, &begin), "vkBeginCommandBuffer");
        params.commands = secondary;
        ASSERT_OK(brume_renderer_record(renderer_, field_, &params));
        gpu::check(vk.EndCommandBuffer(secondary), "vkEndCommandBuffer");
        execute(commands, 1, &secondary);
      });
  EXPECT_EQ(drawn, primary);
  host_.wait();
  vk.DestroyCommandPool(gpu_.device(), pool, nullptr);
}

}  // namespace
}  // namespace brume::host
