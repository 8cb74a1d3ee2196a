// A host application with its own instance, device, queue and frames in flight, under the validation layers.
#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "gpu/context.hpp"
#include "gpu/device_features.hpp"
#include "gpu/host_recording.hpp"

namespace brume::gpu {

class HostApplication {
 public:
  explicit HostApplication(std::size_t frames_in_flight, bool validates = true)
      : instance_(validates), slots_(frames_in_flight) {
    host_.get_instance_proc_addr = system_loader();
    host_.instance = instance_.handle();
    host_.physical_device = choose_device(list_devices(instance_.vk(), host_.instance), "").handle;
    make_device();
    vk_ = instance_.vk();
    vk_.load_device(host_.device);
    vk_.GetDeviceQueue(host_.device, 0, 0, &queue_);
    const VkSemaphoreTypeCreateInfo type{VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO, nullptr,
                                         VK_SEMAPHORE_TYPE_TIMELINE, 0};
    const VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &type, 0};
    check(vk_.CreateSemaphore(host_.device, &semaphore, nullptr, &done_), "vkCreateSemaphore");
    for (Slot& slot : slots_) make_slot(slot);
  }
  ~HostApplication() {
    vk_.DeviceWaitIdle(host_.device);
    for (const Slot& slot : slots_) vk_.DestroyCommandPool(host_.device, slot.pool, nullptr);
    vk_.DestroySemaphore(host_.device, done_, nullptr);
    vk_.DestroyDevice(host_.device, nullptr);
  }
  HostApplication(const HostApplication&) = delete;
  HostApplication& operator=(const HostApplication&) = delete;

  const HostDevice& device() const { return host_; }

  /// Records and submits a frame, once the slot of as many frames before is free.
  void frame(
      const std::function<void(VkCommandBuffer, std::uint64_t frame, std::uint64_t completed)>& record) {
    const std::uint64_t number = ++submitted_;
    if (number > slots_.size()) wait_for(number - slots_.size());
    Slot& slot = slots_[number % slots_.size()];
    check(vk_.ResetCommandPool(host_.device, slot.pool, 0), "vkResetCommandPool");
    const VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr, 0, nullptr};
    check(vk_.BeginCommandBuffer(slot.commands, &begin), "vkBeginCommandBuffer");
    record(slot.commands, number, completed_);
    check(vk_.EndCommandBuffer(slot.commands), "vkEndCommandBuffer");
    const VkCommandBufferSubmitInfo buffer{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO, nullptr,
                                           slot.commands, 0};
    const VkSemaphoreSubmitInfo signal{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO, nullptr, done_, number,
                                       VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,    0};
    VkSubmitInfo2 submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2;
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &buffer;
    submit.signalSemaphoreInfoCount = 1;
    submit.pSignalSemaphoreInfos = &signal;
    check(vk_.QueueSubmit2(queue_, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit2");
  }
  /// Until the device is done with all frames.
  void wait() { wait_for(submitted_); }

  /// Copies an image in the layout GENERAL that compute shaders wrote.
  void copy(VkCommandBuffer commands, VkImage image, VkExtent2D size, VkBuffer to) const {
    const VkMemoryBarrier2 written{
        VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,     nullptr,
        VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
        VK_PIPELINE_STAGE_2_COPY_BIT,           VK_ACCESS_2_TRANSFER_READ_BIT};
    barrier(commands, written);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {size.width, size.height, 1};
    vk_.CmdCopyImageToBuffer(commands, image, VK_IMAGE_LAYOUT_GENERAL, to, 1, &region);
  }

  /// Compute shaders see what was written before.
  void wait_for_compute(VkCommandBuffer commands) const {
    const VkMemoryBarrier2 written{
        VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,     nullptr,
        VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,   VK_ACCESS_2_MEMORY_WRITE_BIT,
        VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};
    barrier(commands, written);
  }

  std::vector<std::string> take_messages() { return instance_.take_messages(); }

 private:
  struct Slot {
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;
  };

  void barrier(VkCommandBuffer commands, const VkMemoryBarrier2& memory) const {
    VkDependencyInfo dependency{};
    dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &memory;
    vk_.CmdPipelineBarrier2(commands, &dependency);
  }
  void make_device() {
    const float priority = 1;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    const DeviceFeatures features;
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.pNext = features.chain();
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    check(instance_.vk().CreateDevice(host_.physical_device, &info, nullptr, &host_.device),
          "vkCreateDevice");
  }
  void make_slot(Slot& slot) {
    const VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, 0, 0};
    check(vk_.CreateCommandPool(host_.device, &pool, nullptr, &slot.pool), "vkCreateCommandPool");
    const VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr,
                                               slot.pool, VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
    check(vk_.AllocateCommandBuffers(host_.device, &allocate, &slot.commands), "vkAllocateCommandBuffers");
  }
  void wait_for(std::uint64_t frame) {
    VkSemaphoreWaitInfo wait{};
    wait.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO;
    wait.semaphoreCount = 1;
    wait.pSemaphores = &done_;
    wait.pValues = &frame;
    check(vk_.WaitSemaphores(host_.device, &wait, ~std::uint64_t{0}), "vkWaitSemaphores");
    completed_ = std::max(completed_, frame);
  }

  Instance instance_;
  HostDevice host_;
  Functions vk_;
  VkQueue queue_ = VK_NULL_HANDLE;
  VkSemaphore done_ = VK_NULL_HANDLE;  // timeline: the number of the last completed frame
  std::uint64_t submitted_ = 0, completed_ = 0;
  std::vector<Slot> slots_;
};

}  // namespace brume::gpu
