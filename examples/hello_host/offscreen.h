// The program without Brume: a Vulkan device, a colour target, a depth image, a room drawn into both, and a
// PNG.
#ifndef OFFSCREEN_H
#define OFFSCREEN_H
#include <math.h>
#include <spng.h>
#include <stdio.h>
#include <stdlib.h>
#include <vulkan/vulkan.h>

enum { kWidth = 640, kHeight = 360 };
// The camera looks along -z. Depth is reversed: 1 at kNear, 0 infinitely far.
static const float kFov = 1.0f, kNear = 0.1f, kEyeX = 0.6f, kEyeY = 1.5f, kEyeZ = 4.5f;

typedef struct Target {
  VkImage image;
  VkImageView view;
  VkImageSubresourceRange range;
} Target;

typedef struct Offscreen {
  VkInstance instance;
  VkPhysicalDevice gpu;
  VkDevice device;
  VkQueue queue;  // the first of family 0
  VkCommandBuffer commands;
  Target picture, depth;
  VkBuffer pixels;
  uint8_t* mapped;  // the memory of `pixels`
} Offscreen;

#define VK(call) expect_success(call, #call)
static void expect_success(VkResult result, const char* call) {
  if (result == VK_SUCCESS) return;
  fprintf(stderr, "%s: VkResult %d\n", call, result);
  exit(1);
}

static VkDeviceMemory allocate(const Offscreen* o, VkMemoryRequirements needs, VkMemoryPropertyFlags flags) {
  VkPhysicalDeviceMemoryProperties memory;
  vkGetPhysicalDeviceMemoryProperties(o->gpu, &memory);
  VkMemoryAllocateInfo info = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, NULL, needs.size, 0};
  for (uint32_t type = memory.memoryTypeCount; type-- > 0;)
    if (needs.memoryTypeBits >> type & 1 && (memory.memoryTypes[type].propertyFlags & flags) == flags)
      info.memoryTypeIndex = type;
  VkDeviceMemory allocation;
  VK(vkAllocateMemory(o->device, &info, NULL, &allocation));
  return allocation;
}

static Target make_target(const Offscreen* o, VkFormat format, VkImageUsageFlags usage,
                          VkImageAspectFlags aspect) {
  Target target = {.range = {aspect, 0, 1, 0, 1}};
  VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                            .imageType = VK_IMAGE_TYPE_2D,
                            .format = format,
                            .extent = {kWidth, kHeight, 1},
                            .mipLevels = 1,
                            .arrayLayers = 1,
                            .samples = VK_SAMPLE_COUNT_1_BIT,
                            .usage = usage};
  VK(vkCreateImage(o->device, &info, NULL, &target.image));
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(o->device, target.image, &needs);
  VK(vkBindImageMemory(o->device, target.image, allocate(o, needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT), 0));
  VkImageViewCreateInfo view = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                .image = target.image,
                                .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                .format = format,
                                .subresourceRange = target.range};
  VK(vkCreateImageView(o->device, &view, NULL, &target.view));
  return target;
}

static void make_device(Offscreen* o, const void* features) {
  VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                   .apiVersion = VK_API_VERSION_1_3};
  VkInstanceCreateInfo instance = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                   .pApplicationInfo = &application};
  VK(vkCreateInstance(&instance, NULL, &o->instance));
  uint32_t count = 1;  // The first device and its first family, which draws and computes nearly everywhere.
  if (vkEnumeratePhysicalDevices(o->instance, &count, &o->gpu) < 0 || count == 0)
    expect_success(VK_ERROR_INITIALIZATION_FAILED, "no Vulkan device");
  const float priority = 1;
  VkDeviceQueueCreateInfo queue = {
      .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, .queueCount = 1, .pQueuePriorities = &priority};
  VkDeviceCreateInfo device = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                               .pNext = features,
                               .queueCreateInfoCount = 1,
                               .pQueueCreateInfos = &queue};
  VK(vkCreateDevice(o->gpu, &device, NULL, &o->device));
  vkGetDeviceQueue(o->device, 0, 0, &o->queue);
}

// `features`: the chain for VkDeviceCreateInfo::pNext.
static Offscreen make_offscreen(const void* features) {
  Offscreen o = {0};
  make_device(&o, features);
  VkCommandPoolCreateInfo pools = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                   .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT};
  VkCommandPool pool;
  VK(vkCreateCommandPool(o.device, &pools, NULL, &pool));
  VkCommandBufferAllocateInfo buffers = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, NULL, pool, 0, 1};
  VK(vkAllocateCommandBuffers(o.device, &buffers, &o.commands));
  o.picture = make_target(&o, VK_FORMAT_R8G8B8A8_SRGB,
                          VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                          VK_IMAGE_ASPECT_COLOR_BIT);
  o.depth = make_target(&o, VK_FORMAT_D32_SFLOAT,
                        VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                        VK_IMAGE_ASPECT_DEPTH_BIT);
  VkBufferCreateInfo pixels = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                               .size = 4 * kWidth * kHeight,
                               .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT};
  VK(vkCreateBuffer(o.device, &pixels, NULL, &o.pixels));
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(o.device, o.pixels, &needs);
  VkDeviceMemory memory =
      allocate(&o, needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  VK(vkBindBufferMemory(o.device, o.pixels, memory, 0));
  VK(vkMapMemory(o.device, memory, 0, VK_WHOLE_SIZE, 0, (void**)&o.mapped));
  return o;
}

// All commands before it end, and the image changes its layout, before any after it begins.
static void barrier(const Offscreen* o, Target target, VkImageLayout from, VkImageLayout to) {
  const VkPipelineStageFlags2 all = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  const VkAccessFlags2 any = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  VkImageMemoryBarrier2 image = {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                 .srcStageMask = all,
                                 .srcAccessMask = any,
                                 .dstStageMask = all,
                                 .dstAccessMask = any,
                                 .oldLayout = from,
                                 .newLayout = to,
                                 .image = target.image,
                                 .subresourceRange = target.range};
  VkDependencyInfo info = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                           .imageMemoryBarrierCount = 1,
                           .pImageMemoryBarriers = &image};
  vkCmdPipelineBarrier2(o->commands, &info);
}

// A rectangle that faces the camera, from (x0, y0) to (x1, y1), `away` along the camera's axis [m].
static void rectangle(const Offscreen* o, float x0, float y0, float x1, float y1, float away, float grey) {
  const float scale = 0.5f * kHeight / tanf(0.5f * kFov) / away;
  const int left = (int)fmaxf(0.5f * kWidth + scale * (x0 - kEyeX), 0);
  const int right = (int)fminf(0.5f * kWidth + scale * (x1 - kEyeX), kWidth);
  const int top = (int)fmaxf(0.5f * kHeight - scale * (y1 - kEyeY), 0);
  const int bottom = (int)fminf(0.5f * kHeight - scale * (y0 - kEyeY), kHeight);
  if (right <= left || bottom <= top) return;
  const VkClearAttachment values[] = {
      {VK_IMAGE_ASPECT_COLOR_BIT, 0, {.color = {{grey, 0.93f * grey, 0.82f * grey, 1}}}},
      {VK_IMAGE_ASPECT_DEPTH_BIT, 0, {.depthStencil = {kNear / away, 0}}}};
  const VkClearRect area = {{{left, top}, {(uint32_t)(right - left), (uint32_t)(bottom - top)}}, 0, 1};
  vkCmdClearAttachments(o->commands, 2, values, 1, &area);
}

// A room 6 m wide, 3 m high and 6 m deep behind a wall at z = 0 with a doorway, and a yard in front of the
// wall. Begins the commands. Afterwards the picture is a colour attachment, and the depth can be sampled.
static void draw_room(const Offscreen* o) {
  VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  VK(vkBeginCommandBuffer(o->commands, &begin));
  barrier(o, o->picture, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
  barrier(o, o->depth, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
  VkRenderingAttachmentInfo color = {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                     .imageView = o->picture.view,
                                     .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                     .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                     .clearValue = {.color = {{0.05f, 0.08f, 0.15f, 1}}}};
  VkRenderingAttachmentInfo depth = {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                     .imageView = o->depth.view,
                                     .imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                                     .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR};
  VkRenderingInfo info = {.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                          .renderArea = {{0, 0}, {kWidth, kHeight}},
                          .layerCount = 1,
                          .colorAttachmentCount = 1,
                          .pColorAttachments = &color,
                          .pDepthAttachment = &depth};
  vkCmdBeginRendering(o->commands, &info);
  // From far to near. A floor is a rectangle below each of its lines.
  rectangle(o, -3, 0, 3, 3, kEyeZ + 6, 0.05f);
  for (float away = kEyeZ + 6; away > kEyeZ; away -= 0.05f) rectangle(o, -3, -9, 3, 0, away, 0.06f);
  rectangle(o, -9, 0, -0.5f, 3.25f, kEyeZ, 0.09f);
  rectangle(o, 0.5f, 0, 9, 3.25f, kEyeZ, 0.09f);
  rectangle(o, -0.5f, 2.25f, 0.5f, 3.25f, kEyeZ, 0.09f);
  for (float away = kEyeZ; away > 2; away -= 0.02f) rectangle(o, -9, -9, 9, 0, away, 0.06f);
  vkCmdEndRendering(o->commands);
  barrier(o, o->depth, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

// Ends the commands with a copy of the picture to `mapped`, submits them and waits.
static void finish_frame(const Offscreen* o) {
  barrier(o, o->picture, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  VkBufferImageCopy all = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                           .imageExtent = {kWidth, kHeight, 1}};
  vkCmdCopyImageToBuffer(o->commands, o->picture.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, o->pixels, 1,
                         &all);
  VK(vkEndCommandBuffer(o->commands));
  VkSubmitInfo submit = {
      .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &o->commands};
  VK(vkQueueSubmit(o->queue, 1, &submit, VK_NULL_HANDLE));
  VK(vkQueueWaitIdle(o->queue));
}

static void save_picture(const Offscreen* o, const char* path) {
  for (int i = 0; i < kWidth * kHeight; ++i) o->mapped[4 * i + 3] = 255;
  FILE* file = fopen(path, "wb");
  spng_ctx* png = spng_ctx_new(SPNG_CTX_ENCODER);
  struct spng_ihdr header = {kWidth, kHeight, 8, SPNG_COLOR_TYPE_TRUECOLOR_ALPHA, 0, 0, 0};
  if (!file || spng_set_png_file(png, file) || spng_set_ihdr(png, &header) ||
      spng_encode_image(png, o->mapped, 4 * kWidth * kHeight, SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE) ||
      fclose(file)) {
    fprintf(stderr, "cannot write %s\n", path);
    exit(1);
  }
  spng_ctx_free(png);
}

#endif
