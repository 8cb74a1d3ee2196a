// A host application with a device, a queue and its own frames in flight, under the validation layers.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gpu/context.hpp"
#include "gpu/device_features.hpp"
#include "gpu/host_recording.hpp"
#include "tests/gpu/godot_features.hpp"
#include "tests/gpu/shared_pipelines.hpp"
#include "tests/thorough.hpp"

namespace brume::gpu {

// What runs long makes and destroys every pipeline of its renderers, under the layers.
inline const bool kSharesPipelines = !is_thorough("frames");

/// The least device is of Vulkan 1.2 and has the required feature alone, Godot's is of Vulkan 1.2, too. Both
/// have timelineSemaphore for the application itself.
enum class HostKind { validated, without_layers, least, godot };
/// Of hosts that ask for none.
inline const HostKind kUsualHost = is_thorough("least") ? HostKind::least : HostKind::validated;

/// The instance and the device of all host applications of a kind in a program.
template <HostKind kKind>
class SharedDevice {
 public:
  using Pipelines = SharedPipelines<SharedDevice>;
  static SharedDevice& get() {
    if (!shared_) shared_ = std::make_unique<SharedDevice>();
    return *shared_;
  }
  /// When all host applications have ended.
  static void end() {
    if (!shared_) return;
    Pipelines::destroy_all();
    shared_->vk.DestroyDevice(shared_->host.device, nullptr);
    for (const std::string& message : shared_->instance.take_messages()) ADD_FAILURE() << message;
    shared_.reset();
  }

  SharedDevice()
      : instance(kKind != HostKind::without_layers, {},
                 kIsOfVulkan12 ? VK_API_VERSION_1_2 : VK_API_VERSION_1_3),
        vk(instance.vk()),
        features(kIsOfVulkan12 ? VK_FALSE : VK_TRUE) {
    host.get_instance_proc_addr = kSharesPipelines ? Pipelines::instance_proc_addr : system_loader();
    host.instance = instance.handle();
    host.physical_device = choose_device(list_devices(vk, host.instance, host_needs()), "").handle;
    const float priority = 1;
    VkDeviceQueueCreateInfo queue{};
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    if (kIsOfVulkan12) {
      vulkan11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES;
      features.features.features.shaderStorageImageExtendedFormats = VK_TRUE;
      features.vulkan12.pNext = &vulkan11;
      host.enabled_features = features.chain();
    }
    if (kKind == HostKind::godot)
      enable_as_godot(vk, host.physical_device, features.features.features, vulkan11, features.vulkan12);
    features.vulkan12.timelineSemaphore = VK_TRUE;  // of `done_`
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.pNext = features.chain();
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    check(vk.CreateDevice(host.physical_device, &info, nullptr, &host.device), "vkCreateDevice");
    vk.load_device(host.device);
    Pipelines::begin(vk, host.device);
  }

  Instance instance;
  Functions vk;
  DeviceFeatures features;
  VkPhysicalDeviceVulkan11Features vulkan11{};
  HostDevice host;

 private:
  static constexpr bool kIsOfVulkan12 = kKind == HostKind::least || kKind == HostKind::godot;
  static inline std::unique_ptr<SharedDevice> shared_;
};

/// After the last test, for messages about what nothing destroyed.
class SharedDevices : public testing::Environment {
 public:
  void TearDown() override {
    SharedDevice<HostKind::validated>::end();
    SharedDevice<HostKind::without_layers>::end();
    SharedDevice<HostKind::least>::end();
    SharedDevice<HostKind::godot>::end();
  }
};
inline testing::Environment* const g_shared_devices = testing::AddGlobalTestEnvironment(new SharedDevices);

class HostApplication {
 public:
  explicit HostApplication(std::size_t frames_in_flight, HostKind kind = kUsualHost)
      : slots_(frames_in_flight) {
    switch (kind) {
      case HostKind::validated:
        use(SharedDevice<HostKind::validated>::get());
        break;
      case HostKind::without_layers:
        use(SharedDevice<HostKind::without_layers>::get());
        break;
      case HostKind::least:
        use(SharedDevice<HostKind::least>::get());
        break;
      case HostKind::godot:
        use(SharedDevice<HostKind::godot>::get());
        break;
    }
    vk_.GetDeviceQueue(host_.device, 0, 0, &queue_);
    const VkSemaphoreTypeCreateInfo type{VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO, nullptr,
                                         VK_SEMAPHORE_TYPE_TIMELINE, 0};
    const VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &type, 0};
    check(vk_.CreateSemaphore(host_.device, &semaphore, nullptr, &done_), "vkCreateSemaphore");
    for (Slot& slot : slots_) make_slot(slot);
  }
  ~HostApplication() {
    vk_.DeviceWaitIdle(host_.device);
    *all_completed_ = *all_submitted_;
    for (const Slot& slot : slots_) vk_.DestroyCommandPool(host_.device, slot.pool, nullptr);
    vk_.DestroySemaphore(host_.device, done_, nullptr);
    for (const std::string& message : take_messages()) ADD_FAILURE() << message;
  }
  HostApplication(const HostApplication&) = delete;
  HostApplication& operator=(const HostApplication&) = delete;

  const HostDevice& device() const { return host_; }

  /// Records and submits a frame, once the slot of as many frames before is free.
  void frame(
      const std::function<void(VkCommandBuffer, std::uint64_t frame, std::uint64_t completed)>& record) {
    const std::uint64_t number = ++submitted_;
    ++*all_submitted_;
    if (number > slots_.size()) wait_for(number - slots_.size());
    Slot& slot = slots_[number % slots_.size()];
    check(vk_.ResetCommandPool(host_.device, slot.pool, 0), "vkResetCommandPool");
    const VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr, 0, nullptr};
    check(vk_.BeginCommandBuffer(slot.commands, &begin), "vkBeginCommandBuffer");
    record(slot.commands, number, completed_);
    check(vk_.EndCommandBuffer(slot.commands), "vkEndCommandBuffer");
    const VkTimelineSemaphoreSubmitInfo timeline{
        VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO, nullptr, 0, nullptr, 1, &number};
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.pNext = &timeline;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &slot.commands;
    submit.signalSemaphoreCount = 1;
    submit.pSignalSemaphores = &done_;
    check(vk_.QueueSubmit(queue_, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
  }
  /// Until the device is done with all frames.
  void wait() { wait_for(submitted_); }

  /// Copies an image in the layout GENERAL that compute shaders wrote.
  void copy(VkCommandBuffer commands, VkImage image, VkExtent2D size, VkBuffer to) const {
    const VkMemoryBarrier written{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, VK_ACCESS_SHADER_WRITE_BIT,
                                  VK_ACCESS_TRANSFER_READ_BIT};
    vk_.CmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0,
                           1, &written, 0, nullptr, 0, nullptr);
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {size.width, size.height, 1};
    vk_.CmdCopyImageToBuffer(commands, image, VK_IMAGE_LAYOUT_GENERAL, to, 1, &region);
  }

  /// Compute shaders see what was written before.
  void wait_for_compute(VkCommandBuffer commands) const {
    const VkMemoryBarrier written{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, VK_ACCESS_MEMORY_WRITE_BIT,
                                  VK_ACCESS_SHADER_READ_BIT};
    vk_.CmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                           0, 1, &written, 0, nullptr, 0, nullptr);
  }

  std::vector<std::string> take_messages() { return instance_->take_messages(); }

 private:
  struct Slot {
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;
  };

  template <HostKind kKind>
  void use(SharedDevice<kKind>& shared) {
    instance_ = &shared.instance;
    host_ = shared.host;
    vk_ = shared.vk;
    all_submitted_ = &SharedDevice<kKind>::Pipelines::frame;
    all_completed_ = &SharedDevice<kKind>::Pipelines::completed;
    submitted_before_ = *all_submitted_;
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
    *all_completed_ = submitted_before_ + completed_;
  }

  Instance* instance_ = nullptr;
  HostDevice host_;
  Functions vk_;
  VkQueue queue_ = VK_NULL_HANDLE;
  VkSemaphore done_ = VK_NULL_HANDLE;  // timeline: the number of the last completed frame
  std::uint64_t submitted_ = 0, completed_ = 0;
  // By all applications of this device, one after the other.
  std::uint64_t *all_submitted_ = nullptr, *all_completed_ = nullptr;
  std::uint64_t submitted_before_ = 0;
  std::vector<Slot> slots_;
};

}  // namespace brume::gpu
