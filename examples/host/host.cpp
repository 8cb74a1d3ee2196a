// A small Vulkan renderer with its own device, depth and frames in flight, and smoke by Brume. smoke.hpp
// contains everything that the smoke requires; this file draws a few boxes, and would work without it.
//
//   brume_host_example [-o FRAME.ppm] [--frames N] [--size WxH] [--in-flight N] [--no-smoke]
//                      [--players N] [--least-scale S] [--taa surfaces|smoke] [--speed S]
//
// Draws N frames without a window and writes the last one. Up to four players share the screen, side by side.
// With a least scale below 1 every frame is drawn in another resolution, and stretched to the screen.
// --taa: temporal anti-aliasing that follows the surfaces alone, so that smoke leaves ghosts behind, or the
// smoke, too (taa.hpp). --speed: how much faster than usual the players move.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "gpu.hpp"
#include "smoke.hpp"
#include "taa.hpp"

namespace {

struct Options {
  std::string out = "frame.ppm";
  std::uint32_t frames = 240, width = 640, height = 360, in_flight = 2, players = 1;
  double least_scale = 1, speed = 1;
  bool smoke = true;
  std::string taa;  // empty: none
};

// ---- The host's own renderer ----

class Host {
 public:
  explicit Host(const Options& options) : options_(options), frames_(options.in_flight) {
    make_layout();
    make_pipeline();
    const VkExtent2D size{options.width, options.height};
    picture_ = gpu_.make_image(
        VK_FORMAT_R16G16B16A16_SFLOAT, size, VK_IMAGE_ASPECT_COLOR_BIT,
        VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    depth_ = gpu_.make_image(VK_FORMAT_D32_SFLOAT, size, VK_IMAGE_ASPECT_DEPTH_BIT,
                             VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    shown_ = gpu_.make_image(VK_FORMAT_R16G16B16A16_SFLOAT, size, VK_IMAGE_ASPECT_COLOR_BIT,
                             VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                 VK_IMAGE_USAGE_SAMPLED_BIT);  // to be viewed
    if (!options.taa.empty()) taa_.emplace(gpu_, size, options.in_flight, options.taa == "smoke");
    make_readback();
    for (Frame& frame : frames_) make_frame(frame);
  }
  brume_device_params lent() const {
    brume_device_params params = brume_device_defaults();
    params.get_instance_proc_addr = vkGetInstanceProcAddr;
    params.instance = gpu_.instance;
    params.physical_device = gpu_.physical;
    params.device = gpu_.device;
    params.queue_family = gpu_.family;
    return params;
  }

  void draw(Smoke* smoke) {
    const std::uint64_t number = ++submitted_;
    Frame& frame = frames_[number % frames_.size()];
    check(vkWaitForFences(gpu_.device, 1, &frame.fence, VK_TRUE, UINT64_MAX), "vkWaitForFences");
    check(vkResetFences(gpu_.device, 1, &frame.fence), "vkResetFences");
    check(vkResetCommandPool(gpu_.device, frame.pool, 0), "vkResetCommandPool");
    const VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr, 0, nullptr};
    check(vkBeginCommandBuffer(frame.commands, &begin), "vkBeginCommandBuffer");
    const double seconds = static_cast<double>(number - 1) / 60;
    const Jitter jitter = taa_ ? jitter_of(number) : Jitter{};
    const std::vector<View> views = views_at(number, options_.speed * seconds);
    draw_boxes(frame.commands, views, jitter);
    // The boxes' depth is to be read, and smoke drawn over the boxes.
    const auto completed = number > frames_.size() ? number - frames_.size() : 0;
    if (smoke)
      smoke->record(frame.commands, number, completed, seconds, depth_.view, picture_.view, views, jitter);
    if (taa_)
      show_accumulated(frame.commands, number, *smoke, views[0].camera, jitter);
    else
      show(frame.commands, picture_, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, kColourUse, views);
    copy_picture(frame.commands);
    check(vkEndCommandBuffer(frame.commands), "vkEndCommandBuffer");
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &frame.commands;
    check(vkQueueSubmit(gpu_.queue, 1, &submit, frame.fence), "vkQueueSubmit");
  }
  void wait() { check(vkDeviceWaitIdle(gpu_.device), "vkDeviceWaitIdle"); }
  /// Writes the last picture, with a simple tone curve.
  void write(const std::string& file) const;

 private:
  struct Frame {
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
  };
  struct Push {
    Matrix clip_from_world;
    Box box;
  };  // as in boxes.vert

  void make_layout();
  std::array<VkPipelineShaderStageCreateInfo, 2> shader_stages() const;
  void make_pipeline();
  void make_readback();
  void make_frame(Frame& frame) const;
  /// Where a player's part of the screen begins [px], also for the one beyond the last.
  std::uint32_t column_of(std::uint32_t player) const { return options_.width * player / options_.players; }
  std::vector<View> views_at(std::uint64_t frame, double seconds) const;
  void draw_boxes(VkCommandBuffer commands, const std::vector<View>& views, Jitter jitter) const;
  void show(VkCommandBuffer commands, const Image& picture, VkImageLayout layout, Use last,
            const std::vector<View>& views) const;
  void show_accumulated(VkCommandBuffer commands, std::uint64_t number, const Smoke& smoke,
                        const Camera& camera, Jitter jitter);
  void copy_picture(VkCommandBuffer commands) const;

  Options options_;
  Gpu gpu_;
  std::optional<Taa> taa_;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
  Image picture_, depth_, shown_;
  VkBuffer readback_ = VK_NULL_HANDLE;
  const std::uint16_t* texels_ = nullptr;
  std::vector<Frame> frames_;
  std::uint64_t submitted_ = 0;
};

void Host::make_layout() {
  const VkPushConstantRange range{VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(Push)};
  VkPipelineLayoutCreateInfo layout{};
  layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  layout.pushConstantRangeCount = 1;
  layout.pPushConstantRanges = &range;
  check(vkCreatePipelineLayout(gpu_.device, &layout, nullptr, &layout_), "vkCreatePipelineLayout");
}

std::array<VkPipelineShaderStageCreateInfo, 2> Host::shader_stages() const {
  static constexpr std::uint32_t kVertex[] =
#include "boxes.vert.inc"
      ;
  static constexpr std::uint32_t kFragment[] =
#include "boxes.frag.inc"
      ;
  std::array<VkPipelineShaderStageCreateInfo, 2> stages{};
  for (std::size_t i = 0; i < 2; ++i) {
    stages[i].sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    stages[i].stage = i == 0 ? VK_SHADER_STAGE_VERTEX_BIT : VK_SHADER_STAGE_FRAGMENT_BIT;
    stages[i].module = i == 0 ? gpu_.make_module(kVertex) : gpu_.make_module(kFragment);
    stages[i].pName = "main";
  }
  return stages;
}

void Host::make_pipeline() {
  const auto stages = shader_stages();
  VkPipelineVertexInputStateCreateInfo input{};
  input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
  VkPipelineInputAssemblyStateCreateInfo assembly{};
  assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  VkPipelineViewportStateCreateInfo view{};
  view.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
  view.viewportCount = view.scissorCount = 1;
  constexpr VkDynamicState kOfViews[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  VkPipelineDynamicStateCreateInfo dynamic{};
  dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
  dynamic.dynamicStateCount = 2;
  dynamic.pDynamicStates = kOfViews;
  VkPipelineRasterizationStateCreateInfo raster{};
  raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
  raster.lineWidth = 1;
  VkPipelineMultisampleStateCreateInfo samples{};
  samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  VkPipelineDepthStencilStateCreateInfo depth{};
  depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
  depth.depthTestEnable = depth.depthWriteEnable = VK_TRUE;
  depth.depthCompareOp = VK_COMPARE_OP_GREATER;
  VkPipelineColorBlendAttachmentState colour{};
  colour.colorWriteMask = 0xf;
  VkPipelineColorBlendStateCreateInfo blend{};
  blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
  blend.attachmentCount = 1;
  blend.pAttachments = &colour;
  const VkFormat format = VK_FORMAT_R16G16B16A16_SFLOAT;
  VkPipelineRenderingCreateInfo rendering{};
  rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
  rendering.colorAttachmentCount = 1;
  rendering.pColorAttachmentFormats = &format;
  rendering.depthAttachmentFormat = VK_FORMAT_D32_SFLOAT;
  VkGraphicsPipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
  info.pNext = &rendering;
  info.stageCount = 2;
  info.pStages = stages.data();
  info.pVertexInputState = &input;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &view;
  info.pDynamicState = &dynamic;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.pDepthStencilState = &depth;
  info.pColorBlendState = &blend;
  info.layout = layout_;
  check(vkCreateGraphicsPipelines(gpu_.device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_),
        "vkCreateGraphicsPipelines");
}

void Host::make_readback() {
  VkBufferCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  info.size = VkDeviceSize{8} * options_.width * options_.height;
  info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  check(vkCreateBuffer(gpu_.device, &info, nullptr, &readback_), "vkCreateBuffer");
  VkMemoryRequirements needs{};
  vkGetBufferMemoryRequirements(gpu_.device, readback_, &needs);
  const VkDeviceMemory memory =
      gpu_.allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  check(vkBindBufferMemory(gpu_.device, readback_, memory, 0), "vkBindBufferMemory");
  void* mapped = nullptr;
  check(vkMapMemory(gpu_.device, memory, 0, VK_WHOLE_SIZE, 0, &mapped), "vkMapMemory");
  texels_ = static_cast<const std::uint16_t*>(mapped);
}

void Host::make_frame(Frame& frame) const {
  const VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, 0, gpu_.family};
  check(vkCreateCommandPool(gpu_.device, &pool, nullptr, &frame.pool), "vkCreateCommandPool");
  const VkCommandBufferAllocateInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr,
                                             frame.pool, VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
  check(vkAllocateCommandBuffers(gpu_.device, &commands, &frame.commands), "vkAllocateCommandBuffers");
  const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr, VK_FENCE_CREATE_SIGNALED_BIT};
  check(vkCreateFence(gpu_.device, &fence, nullptr, &frame.fence), "vkCreateFence");
}

/// The players' views side by side, each in the resolution of the frame.
std::vector<View> Host::views_at(std::uint64_t frame, double seconds) const {
  const double scale = options_.least_scale +
                       (1 - options_.least_scale) * std::abs(std::cos(0.37 * static_cast<double>(frame)));
  const auto scaled = [&](std::uint32_t px) {
    return std::max(static_cast<std::uint32_t>(scale * px + 0.5), 1u);
  };
  std::vector<View> views;
  for (std::uint32_t i = 0; i < options_.players; ++i)
    views.push_back({camera_at(seconds, i), column_of(i), 0, scaled(column_of(i + 1) - column_of(i)),
                     scaled(options_.height)});
  return views;
}

/// Stretches the views of a picture to the screen.
void Host::show(VkCommandBuffer commands, const Image& picture, VkImageLayout layout, Use last,
                const std::vector<View>& views) const {
  gpu_.transition(commands, picture, layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, last, kBlitReads);
  // The frame before has copied what it showed.
  gpu_.transition(commands, shown_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                  {kCopyReads.stages, 0}, kBlitWrites);
  for (std::uint32_t i = 0; i < views.size(); ++i) {
    const View& view = views[i];
    const auto corner = [](std::uint32_t x, std::uint32_t y, std::int32_t z) {
      return VkOffset3D{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), z};
    };
    VkImageBlit blit{};
    blit.srcSubresource = blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    blit.srcOffsets[0] = blit.dstOffsets[0] = corner(view.x, view.y, 0);
    blit.srcOffsets[1] = corner(view.x + view.width, view.y + view.height, 1);
    blit.dstOffsets[1] = corner(column_of(i + 1), options_.height, 1);
    vkCmdBlitImage(commands, picture.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, shown_.handle,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit, VK_FILTER_LINEAR);
  }
}

/// Shows what the frames so far amount to.
void Host::show_accumulated(VkCommandBuffer commands, std::uint64_t number, const Smoke& smoke,
                            const Camera& camera, Jitter jitter) {
  gpu_.transition(commands, picture_, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                  VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, kColourUse, kComputeReads);
  const brume::api::Image media = smoke.renderer.smoke(), motion = smoke.renderer.motion();
  for (const auto& brume_image : {media, motion})
    gpu_.transition(commands, {brume_image.image, brume_image.view, VK_IMAGE_ASPECT_COLOR_BIT},
                    VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL, kComputeWrites, kComputeReads);
  const Image& shown =
      taa_->record(commands, number, {picture_.view, depth_.view, media.view, motion.view, camera, jitter});
  const std::vector<View> whole{{camera, 0, 0, options_.width, options_.height}};
  show(commands, shown, VK_IMAGE_LAYOUT_GENERAL, kComputeWrites, whole);
  gpu_.transition(commands, shown, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL, kBlitReads,
                  kComputeReads);
}

void Host::draw_boxes(VkCommandBuffer commands, const std::vector<View>& views, Jitter jitter) const {
  // The frame before has shown its picture, and its smoke has read its depth.
  gpu_.transition(commands, picture_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                  {kBlitReads.stages | kComputeReads.stages, 0}, kColourUse);
  gpu_.transition(commands, depth_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                  {kComputeReads.stages, 0}, kDepthUse);
  VkRenderingAttachmentInfo colour{};
  colour.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
  colour.imageView = picture_.view;
  colour.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  colour.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
  colour.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  colour.clearValue.color = {{0.015f, 0.024f, 0.05f, 1}};
  VkRenderingAttachmentInfo depth = colour;
  depth.imageView = depth_.view;
  depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
  depth.clearValue = {};
  VkRenderingInfo rendering{};
  rendering.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
  rendering.renderArea.extent = {options_.width, options_.height};
  rendering.layerCount = 1;
  rendering.colorAttachmentCount = 1;
  rendering.pColorAttachments = &colour;
  rendering.pDepthAttachment = &depth;
  vkCmdBeginRendering(commands, &rendering);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_);
  for (const View& view : views) {
    const float width = static_cast<float>(view.width), height = static_cast<float>(view.height);
    const VkViewport viewport{static_cast<float>(view.x), static_cast<float>(view.y), width, height, 0, 1};
    const VkRect2D scissor{{static_cast<std::int32_t>(view.x), static_cast<std::int32_t>(view.y)},
                           {view.width, view.height}};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &scissor);
    for (const Box& box : kLevel) {
      const Push push{jittered(matrix_of(view.camera, width / height), jitter, width, height), box};
      vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof push, &push);
      vkCmdDraw(commands, 36, 1, 0, 0);
    }
  }
  vkCmdEndRendering(commands);
  gpu_.transition(commands, depth_, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                  VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, kDepthUse, kComputeReads);
  gpu_.transition(commands, picture_, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                  VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, kColourUse, kColourUse);
}

void Host::copy_picture(VkCommandBuffer commands) const {
  gpu_.transition(commands, shown_, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                  VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, kBlitWrites, kCopyReads);
  // All frames are copied to one place.
  const VkMemoryBarrier2 copies{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2, nullptr,
                                VK_PIPELINE_STAGE_2_COPY_BIT,       VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                VK_PIPELINE_STAGE_2_COPY_BIT,       VK_ACCESS_2_TRANSFER_WRITE_BIT};
  VkDependencyInfo dependency{};
  dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  dependency.memoryBarrierCount = 1;
  dependency.pMemoryBarriers = &copies;
  vkCmdPipelineBarrier2(commands, &dependency);
  VkBufferImageCopy region{};
  region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.imageExtent = {options_.width, options_.height, 1};
  vkCmdCopyImageToBuffer(commands, shown_.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, readback_, 1,
                         &region);
}

/// A positive half float.
float from_half(std::uint16_t half) {
  const int exponent = half >> 10 & 31, mantissa = half & 1023;
  return exponent == 0 ? std::ldexp(static_cast<float>(mantissa), -24)
                       : std::ldexp(static_cast<float>(1024 + mantissa), exponent - 25);
}

void Host::write(const std::string& file) const {
  std::FILE* out = std::fopen(file.c_str(), "wb");
  if (!out) throw std::runtime_error(file + ": cannot be written");
  std::fprintf(out, "P6\n%u %u\n255\n", options_.width, options_.height);
  std::vector<unsigned char> bytes;
  for (std::size_t i = 0; i < std::size_t{4} * options_.width * options_.height; ++i) {
    if (i % 4 == 3) continue;
    const float shown = std::pow(1 - std::exp(-2.5f * from_half(texels_[i])), 1 / 2.2f);
    bytes.push_back(static_cast<unsigned char>(255 * std::clamp(shown, 0.0f, 1.0f) + 0.5f));
  }
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), out) == bytes.size();
  if (std::fclose(out) != 0 || !written) throw std::runtime_error(file + ": cannot be written");
}

Options read_options(int count, char** arguments) {
  Options options;
  for (int i = 1; i < count; ++i) {
    const std::string_view name = arguments[i];
    const char* value = i + 1 < count ? arguments[i + 1] : "";
    if (name == "--no-smoke") {
      options.smoke = false;
      continue;
    }
    if (name == "-o")
      options.out = value;
    else if (name == "--frames")
      options.frames = static_cast<std::uint32_t>(std::atoi(value));
    else if (name == "--in-flight")
      options.in_flight = static_cast<std::uint32_t>(std::atoi(value));
    else if (name == "--players")
      options.players = static_cast<std::uint32_t>(std::atoi(value));
    else if (name == "--least-scale")
      options.least_scale = std::atof(value);
    else if (name == "--speed")
      options.speed = std::atof(value);
    else if (name == "--taa")
      options.taa = value;
    else if (name != "--size" || std::sscanf(value, "%ux%u", &options.width, &options.height) != 2)
      throw std::runtime_error(
          "usage: brume_host_example [-o FRAME.ppm] [--frames N] [--size WxH] [--in-flight N] [--no-smoke] "
          "[--players N] [--least-scale S] [--taa surfaces|smoke] [--speed S]");
    ++i;
  }
  if (options.players < 1 || options.players > BRUME_MAX_VIEWS || options.width < options.players ||
      !(options.least_scale > 0 && options.least_scale <= 1))
    throw std::runtime_error("--players must be 1 to 4, and --least-scale above 0 and at most 1");
  if (!options.taa.empty() && ((options.taa != "surfaces" && options.taa != "smoke") || options.players > 1 ||
                               options.least_scale < 1 || !options.smoke))
    throw std::runtime_error("--taa must be surfaces or smoke, for one player in full resolution with smoke");
  if (options.frames < 1 || options.in_flight < 1 || options.in_flight > 8 || options.width < 1 ||
      options.height < 1)
    throw std::runtime_error("--frames, --size and --in-flight must be at least 1, --in-flight at most 8");
  return options;
}

}  // namespace

int main(int count, char** arguments) {
  try {
    const Options options = read_options(count, arguments);
    Host host(options);
    {
      std::unique_ptr<Smoke> smoke;
      if (options.smoke)
        smoke = std::make_unique<Smoke>(host.lent(), options.width, options.height, !options.taa.empty());
      for (std::uint32_t frame = 0; frame < options.frames; ++frame) host.draw(smoke.get());
      host.wait();
    }
    host.write(options.out);
    return 0;
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "brume_host_example: %s\n", error.what()), 1;
  }
}
