// A small Vulkan renderer with its own device, depth and frames in flight, and smoke by Brume. smoke.hpp
// contains everything that the smoke requires; this file draws a few boxes, and would work without it.
//
//   brume_host_example [-o FRAME.ppm] [--frames N] [--size WxH] [--in-flight N] [--no-smoke]
//                      [--players N] [--least-scale S]
//
// Draws N frames without a window and writes the last one. Up to four players share the screen, side by side.
// With a least scale below 1 every frame is drawn in another resolution, and stretched to the screen.
#include <brume/brume_vulkan.h>
#include <vulkan/vulkan.h>
#include <brume/brume.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "smoke.hpp"

namespace {

struct Options {
  std::string out = "frame.ppm";
  std::uint32_t frames = 240, width = 640, height = 360, in_flight = 2, players = 1;
  double least_scale = 1;
  bool smoke = true;
};

/// The matrix from world space to clip space, column by column.
std::array<float, 16> matrix_of(const Camera& camera, float aspect) {
  const Vec3 right = unit(cross(camera.forward, camera.up)), up = cross(right, camera.forward),
             f = camera.forward;
  const float y = 1 / std::tan(0.5f * kFieldOfView), x = y / aspect;
  const Vec3 p = camera.position;
  return {x * right.x, -y * up.x, 0, f.x, x * right.y,        -y * up.y,      0,     f.y,
          x * right.z, -y * up.z, 0, f.z, -x * dot(right, p), y * dot(up, p), kNear, -dot(f, p)};
}

void check(VkResult result, const char* what) {
  if (result != VK_SUCCESS)
    throw std::runtime_error(std::string(what) + " failed: " + std::to_string(result));
}

// ---- The host's own renderer ----

class Host {
 public:
  explicit Host(const Options& options) : options_(options), frames_(options.in_flight) {
    make_device();
    make_layout();
    make_pipeline();
    picture_ = make_image(VK_FORMAT_R16G16B16A16_SFLOAT, VK_IMAGE_ASPECT_COLOR_BIT,
                          VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    depth_ = make_image(VK_FORMAT_D32_SFLOAT, VK_IMAGE_ASPECT_DEPTH_BIT,
                        VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    shown_ = make_image(VK_FORMAT_R16G16B16A16_SFLOAT, VK_IMAGE_ASPECT_COLOR_BIT,
                        VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                            VK_IMAGE_USAGE_SAMPLED_BIT);  // to be viewed
    make_readback();
    for (Frame& frame : frames_) make_frame(frame);
  }
  // Everything ends with the process; a real host destroys what it made.

  brume_device_params lent() const {
    brume_device_params params = brume_device_defaults();
    params.get_instance_proc_addr = vkGetInstanceProcAddr;
    params.instance = instance_;
    params.physical_device = physical_;
    params.device = device_;
    params.queue_family = family_;
    return params;
  }

  void draw(Smoke* smoke) {
    const std::uint64_t number = ++submitted_;
    Frame& frame = frames_[number % frames_.size()];
    check(vkWaitForFences(device_, 1, &frame.fence, VK_TRUE, UINT64_MAX), "vkWaitForFences");
    check(vkResetFences(device_, 1, &frame.fence), "vkResetFences");
    check(vkResetCommandPool(device_, frame.pool, 0), "vkResetCommandPool");
    const VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr, 0, nullptr};
    check(vkBeginCommandBuffer(frame.commands, &begin), "vkBeginCommandBuffer");
    const double seconds = static_cast<double>(number - 1) / 60;
    const std::vector<View> views = views_at(number, seconds);
    draw_boxes(frame.commands, views);
    // The boxes' depth is to be read, and smoke drawn over the boxes.
    const auto completed = number > frames_.size() ? number - frames_.size() : 0;
    if (smoke) smoke->record(frame.commands, number, completed, seconds, depth_.view, picture_.view, views);
    show(frame.commands, views);
    copy_picture(frame.commands);
    check(vkEndCommandBuffer(frame.commands), "vkEndCommandBuffer");
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &frame.commands;
    check(vkQueueSubmit(queue_, 1, &submit, frame.fence), "vkQueueSubmit");
  }
  void wait() { check(vkDeviceWaitIdle(device_), "vkDeviceWaitIdle"); }
  /// Writes the last picture, with a simple tone curve.
  void write(const std::string& file) const;

 private:
  struct Image {
    VkImage handle = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;
    VkImageAspectFlags aspect = 0;
  };
  struct Frame {
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
  };
  struct Push {
    std::array<float, 16> clip_from_world;
    Box box;
  };  // as in boxes.vert

  void make_device();
  void make_layout();
  std::array<VkPipelineShaderStageCreateInfo, 2> shader_stages() const;
  void make_pipeline();
  VkDeviceMemory allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags properties) const;
  Image make_image(VkFormat format, VkImageAspectFlags aspect, VkImageUsageFlags usage) const;
  void make_readback();
  void make_frame(Frame& frame) const;
  VkShaderModule make_module(const std::uint32_t* words, std::size_t bytes) const;
  void transition(VkCommandBuffer commands, const Image& image, VkImageLayout from, VkImageLayout to,
                  VkPipelineStageFlags2 from_stages, VkAccessFlags2 from_access,
                  VkPipelineStageFlags2 to_stages, VkAccessFlags2 to_access) const;
  std::vector<View> views_at(std::uint64_t frame, double seconds) const;
  void draw_boxes(VkCommandBuffer commands, const std::vector<View>& views) const;
  void show(VkCommandBuffer commands, const std::vector<View>& views) const;
  void copy_picture(VkCommandBuffer commands) const;

  Options options_;
  VkInstance instance_ = VK_NULL_HANDLE;
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  std::uint32_t family_ = 0;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
  Image picture_, depth_, shown_;
  VkBuffer readback_ = VK_NULL_HANDLE;
  const std::uint16_t* texels_ = nullptr;
  std::vector<Frame> frames_;
  std::uint64_t submitted_ = 0;
};

void Host::make_device() {
  VkApplicationInfo application{};
  application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
  application.apiVersion = VK_API_VERSION_1_3;
  VkInstanceCreateInfo instance{};
  instance.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
  instance.pApplicationInfo = &application;
  check(vkCreateInstance(&instance, nullptr, &instance_), "vkCreateInstance");
  std::uint32_t count = 1;
  if (vkEnumeratePhysicalDevices(instance_, &count, &physical_) < 0 || count == 0)
    throw std::runtime_error("no Vulkan device");
  // The first family of a device that draws also computes, on every common one.
  const float priority = 1;
  VkDeviceQueueCreateInfo queue{};
  queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queue.queueFamilyIndex = family_;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  VkDeviceCreateInfo device{};
  device.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  device.pNext = brume_vulkan_features();
  device.queueCreateInfoCount = 1;
  device.pQueueCreateInfos = &queue;
  check(vkCreateDevice(physical_, &device, nullptr, &device_), "vkCreateDevice");
  vkGetDeviceQueue(device_, family_, 0, &queue_);
}

VkShaderModule Host::make_module(const std::uint32_t* words, std::size_t bytes) const {
  const VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, nullptr, 0, bytes, words};
  VkShaderModule module = VK_NULL_HANDLE;
  check(vkCreateShaderModule(device_, &info, nullptr, &module), "vkCreateShaderModule");
  return module;
}

void Host::make_layout() {
  const VkPushConstantRange range{VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(Push)};
  VkPipelineLayoutCreateInfo layout{};
  layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  layout.pushConstantRangeCount = 1;
  layout.pPushConstantRanges = &range;
  check(vkCreatePipelineLayout(device_, &layout, nullptr, &layout_), "vkCreatePipelineLayout");
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
    stages[i].module =
        i == 0 ? make_module(kVertex, sizeof kVertex) : make_module(kFragment, sizeof kFragment);
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
  check(vkCreateGraphicsPipelines(device_, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_),
        "vkCreateGraphicsPipelines");
}

VkDeviceMemory Host::allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags properties) const {
  VkPhysicalDeviceMemoryProperties memory{};
  vkGetPhysicalDeviceMemoryProperties(physical_, &memory);
  std::uint32_t type = 0;
  while (type < memory.memoryTypeCount &&
         (!(needs.memoryTypeBits >> type & 1) ||
          (memory.memoryTypes[type].propertyFlags & properties) != properties))
    ++type;
  const VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needs.size, type};
  VkDeviceMemory made = VK_NULL_HANDLE;
  check(vkAllocateMemory(device_, &info, nullptr, &made), "vkAllocateMemory");
  return made;
}

Host::Image Host::make_image(VkFormat format, VkImageAspectFlags aspect, VkImageUsageFlags usage) const {
  Image image;
  image.aspect = aspect;
  VkImageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = {options_.width, options_.height, 1};
  info.mipLevels = info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = usage;
  check(vkCreateImage(device_, &info, nullptr, &image.handle), "vkCreateImage");
  VkMemoryRequirements needs{};
  vkGetImageMemoryRequirements(device_, image.handle, &needs);
  check(vkBindImageMemory(device_, image.handle, allocate(needs, 0), 0), "vkBindImageMemory");
  VkImageViewCreateInfo view{};
  view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  view.image = image.handle;
  view.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view.format = format;
  view.subresourceRange = {aspect, 0, 1, 0, 1};
  check(vkCreateImageView(device_, &view, nullptr, &image.view), "vkCreateImageView");
  return image;
}

void Host::make_readback() {
  VkBufferCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  info.size = VkDeviceSize{8} * options_.width * options_.height;
  info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  check(vkCreateBuffer(device_, &info, nullptr, &readback_), "vkCreateBuffer");
  VkMemoryRequirements needs{};
  vkGetBufferMemoryRequirements(device_, readback_, &needs);
  const VkDeviceMemory memory =
      allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  check(vkBindBufferMemory(device_, readback_, memory, 0), "vkBindBufferMemory");
  void* mapped = nullptr;
  check(vkMapMemory(device_, memory, 0, VK_WHOLE_SIZE, 0, &mapped), "vkMapMemory");
  texels_ = static_cast<const std::uint16_t*>(mapped);
}

void Host::make_frame(Frame& frame) const {
  const VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, 0, family_};
  check(vkCreateCommandPool(device_, &pool, nullptr, &frame.pool), "vkCreateCommandPool");
  const VkCommandBufferAllocateInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr,
                                             frame.pool, VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
  check(vkAllocateCommandBuffers(device_, &commands, &frame.commands), "vkAllocateCommandBuffers");
  const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr, VK_FENCE_CREATE_SIGNALED_BIT};
  check(vkCreateFence(device_, &fence, nullptr, &frame.fence), "vkCreateFence");
}

void Host::transition(VkCommandBuffer commands, const Image& image, VkImageLayout from, VkImageLayout to,
                      VkPipelineStageFlags2 from_stages, VkAccessFlags2 from_access,
                      VkPipelineStageFlags2 to_stages, VkAccessFlags2 to_access) const {
  VkImageMemoryBarrier2 barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
  barrier.srcStageMask = from_stages;
  barrier.srcAccessMask = from_access;
  barrier.dstStageMask = to_stages;
  barrier.dstAccessMask = to_access;
  barrier.oldLayout = from;
  barrier.newLayout = to;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image.handle;
  barrier.subresourceRange = {image.aspect, 0, 1, 0, 1};
  VkDependencyInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  info.imageMemoryBarrierCount = 1;
  info.pImageMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &info);
}

constexpr VkPipelineStageFlags2 kColour = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
constexpr VkPipelineStageFlags2 kDepthTests =
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
constexpr VkAccessFlags2 kColourAccess =
    VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT;
constexpr VkAccessFlags2 kDepthAccess =
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT;

/// The players' views side by side, each in the resolution of the frame.
std::vector<View> Host::views_at(std::uint64_t frame, double seconds) const {
  const double scale = options_.least_scale +
                       (1 - options_.least_scale) * std::abs(std::cos(0.37 * static_cast<double>(frame)));
  const auto scaled = [&](std::uint32_t px) {
    return std::max(static_cast<std::uint32_t>(scale * px + 0.5), 1u);
  };
  const std::uint32_t across = options_.width / options_.players;
  std::vector<View> views;
  for (std::uint32_t i = 0; i < options_.players; ++i)
    views.push_back({camera_at(seconds, i), i * across, 0, scaled(across), scaled(options_.height)});
  return views;
}

/// Stretches the views to the screen.
void Host::show(VkCommandBuffer commands, const std::vector<View>& views) const {
  transition(commands, picture_, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
             VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, kColour, kColourAccess, VK_PIPELINE_STAGE_2_BLIT_BIT,
             VK_ACCESS_2_TRANSFER_READ_BIT);
  // The frame before has copied what it showed.
  transition(commands, shown_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
             VK_PIPELINE_STAGE_2_COPY_BIT, 0, VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
  const std::uint32_t across = options_.width / options_.players;
  for (const View& view : views) {
    const auto corner = [](std::uint32_t x, std::uint32_t y, std::int32_t z) {
      return VkOffset3D{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y), z};
    };
    VkImageBlit blit{};
    blit.srcSubresource = blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    blit.srcOffsets[0] = blit.dstOffsets[0] = corner(view.x, view.y, 0);
    blit.srcOffsets[1] = corner(view.x + view.width, view.y + view.height, 1);
    blit.dstOffsets[1] = corner(view.x + across, options_.height, 1);
    vkCmdBlitImage(commands, picture_.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, shown_.handle,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit, VK_FILTER_LINEAR);
  }
}

void Host::draw_boxes(VkCommandBuffer commands, const std::vector<View>& views) const {
  // The frame before has shown its picture, and its smoke has read its depth.
  transition(commands, picture_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
             VK_PIPELINE_STAGE_2_BLIT_BIT, 0, kColour, kColourAccess);
  transition(commands, depth_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
             VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, 0, kDepthTests, kDepthAccess);
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
      const Push push{matrix_of(view.camera, width / height), box};
      vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof push, &push);
      vkCmdDraw(commands, 36, 1, 0, 0);
    }
  }
  vkCmdEndRendering(commands);
  transition(commands, depth_, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
             VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, kDepthTests, kDepthAccess,
             VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT);
  transition(commands, picture_, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
             VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, kColour, kColourAccess, kColour, kColourAccess);
}

void Host::copy_picture(VkCommandBuffer commands) const {
  transition(commands, shown_, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
             VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_COPY_BIT,
             VK_ACCESS_2_TRANSFER_READ_BIT);
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
    else if (name != "--size" || std::sscanf(value, "%ux%u", &options.width, &options.height) != 2)
      throw std::runtime_error(
          "usage: brume_host_example [-o FRAME.ppm] [--frames N] [--size WxH] [--in-flight N] [--no-smoke] "
          "[--players N] [--least-scale S]");
    ++i;
  }
  if (options.players < 1 || options.players > BRUME_MAX_VIEWS || options.width < options.players ||
      !(options.least_scale > 0 && options.least_scale <= 1))
    throw std::runtime_error("--players must be 1 to 4, and --least-scale above 0 and at most 1");
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
      if (options.smoke) smoke = std::make_unique<Smoke>(host.lent(), options.width, options.height);
      for (std::uint32_t frame = 0; frame < options.frames; ++frame) host.draw(smoke.get());
      host.wait();
    }
    host.write(options.out);
    return 0;
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "brume_host_example: %s\n", error.what()), 1;
  }
}
