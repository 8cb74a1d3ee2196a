#include "gpu/context.hpp"

#include <algorithm>
#include <string>

#include "core/error.hpp"
#include "gpu/device_features.hpp"

namespace brume::gpu {
namespace {

constexpr VkQueueFlags kQueues = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
constexpr std::uint64_t kWaitNanoseconds = 600'000'000'000;  // Ten minutes: a software device may be slow.

std::vector<VkQueueFamilyProperties> queue_families(const Functions& vk, VkPhysicalDevice device) {
  std::uint32_t count = 0;
  vk.GetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vk.GetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  return families;
}

std::uint32_t find_queue_family(const Functions& vk, VkInstance instance, VkPhysicalDevice device,
                                const Presentation& presentation) {
  const std::vector<VkQueueFamilyProperties> families = queue_families(vk, device);
  for (std::uint32_t i = 0; i < families.size(); ++i) {
    if ((families[i].queueFlags & kQueues) != kQueues) continue;
    if (!presentation.supported || presentation.supported(instance, device, i)) return i;
  }
  if (presentation.supported)
    throw Error(ErrorCode::no_device, "the Vulkan device cannot present to this window system");
  throw Error(ErrorCode::no_device, "the Vulkan device has no queue for graphics and compute");
}

/// Throws when the host's queue family cannot run our commands.
void check_queue_family(const Functions& vk, const HostDevice& host) {
  const std::vector<VkQueueFamilyProperties> families = queue_families(vk, host.physical_device);
  const std::string family = "the queue family " + std::to_string(host.queue_family);
  if (host.queue_family >= families.size())
    throw Error(ErrorCode::usage, family + " does not exist: the physical device has " +
                                      std::to_string(families.size()) + ", numbered from 0");
  const VkQueueFlags flags = families[host.queue_family].queueFlags;
  if ((flags & kQueues) == kQueues) return;
  const char* const lacks = flags & VK_QUEUE_COMPUTE_BIT    ? "graphics"
                            : flags & VK_QUEUE_GRAPHICS_BIT ? "compute"
                                                            : "graphics and compute";
  throw Error(ErrorCode::usage, family + " lacks " + lacks + "; choose one with graphics and compute");
}

/// The optional features of the host's device. Throws when it was created without one that is required.
OptionalFeatures enabled_features(const Functions& vk, const HostDevice& host) {
  if (!host.enabled_features) {
    DeviceFeatures supported(VK_FALSE);
    vk.GetPhysicalDeviceFeatures2(host.physical_device, &supported.features);
    return *optional_features_of(supported.chain());
  }
  const auto missing = first_missing(host.enabled_features, required_features());
  if (!missing) throw Error(ErrorCode::usage, "`enabled_features`: " + missing.failure().message);
  if (*missing)
    throw Error(ErrorCode::no_device,
                std::string("the device was created without ") + (*missing)->name + "; enable it");
  return *optional_features_of(host.enabled_features);
}

}  // namespace

Context::Context(const ContextOptions& options)
    : instance_(std::make_unique<Instance>(options.validation, options.presentation.instance_extensions)),
      vk_(instance_->vk()) {
  const auto devices = list_devices(vk_, instance_->handle());
  info_ = choose_device(devices, options.device);
  create_device(options.presentation);
  read_properties();
  memory_ = std::make_unique<Memory>(vk_, info_.handle, device_, MemoryOptions{.fill = options.validation});
  pipelines_ = std::make_shared<PipelineStore>(vk_, device_, VK_NULL_HANDLE);
}

Context::Context(const HostDevice& host, Context* pipelines_of)
    : device_(host.device), queue_family_(host.queue_family) {
  vk_.allocator = host.allocator;
  vk_.load_instance(host.get_instance_proc_addr, host.instance);
  for (const DeviceInfo& device : list_devices(vk_, host.instance, host_needs())) {
    if (device.handle == host.physical_device) info_ = device;
  }
  if (!info_.handle)
    throw Error(ErrorCode::no_device, "the host's physical device is not one of its instance");
  if (!info_.unsupported.empty())
    throw Error(ErrorCode::no_device, "the device " + info_.name + " cannot be used: " + info_.unsupported);
  check_queue_family(vk_, host);
  enabled_ = pipelines_of ? pipelines_of->enabled_ : enabled_features(vk_, host);
  vk_.load_device(device_, enabled_);
  read_properties();
  if (!enabled_.sampler_anisotropy) tuning_.surface_anisotropy = 1;
  // What a host is short of comes and goes in smaller blocks.
  memory_ = std::make_unique<Memory>(
      vk_, info_.handle, device_,
      MemoryOptions{.block_bytes = 16u << 20, .dedicated_bytes = 4u << 20, .callbacks = host.memory});
  pipelines_ = pipelines_of ? pipelines_of->pipelines_
                            : std::make_shared<PipelineStore>(vk_, device_, host.pipeline_cache);
}

void Context::create_device(const Presentation& presentation) {
  // One queue for graphics and compute.
  queue_family_ = find_queue_family(vk_, instance_->handle(), info_.handle, presentation);
  const float priority = 1;
  VkDeviceQueueCreateInfo queue{};
  queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queue.queueFamilyIndex = queue_family_;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;

  // The device, with a swapchain for presentation.
  DeviceFeatures features;
  features.vulkan12.timelineSemaphore = VK_TRUE;
  VkDeviceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  info.pNext = features.chain();
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  const char* const swapchain = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
  const bool shows = !presentation.instance_extensions.empty();
  info.enabledExtensionCount = shows ? 1 : 0;
  info.ppEnabledExtensionNames = &swapchain;
  check(vk_.CreateDevice(info_.handle, &info, nullptr, &device_), "vkCreateDevice");
  vk_.load_device(device_);
  if (shows) vk_.load_swapchain(device_);
  vk_.GetDeviceQueue(device_, queue_family_, 0, &queue_);

  // The timeline semaphore of submissions.
  const VkSemaphoreTypeCreateInfo type{VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO, nullptr,
                                       VK_SEMAPHORE_TYPE_TIMELINE, 0};
  const VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &type, 0};
  const VkResult result = vk_.CreateSemaphore(device_, &semaphore, vk_.allocator, &done_);
  if (result != VK_SUCCESS) vk_.DestroyDevice(device_, nullptr);
  check(result, "vkCreateSemaphore");
}

void Context::read_properties() {
  tuning_ = tuning_for(info_.kind);
  VkPhysicalDeviceProperties2 properties{};
  properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  VkPhysicalDeviceMaintenance3Properties maintenance{};
  maintenance.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES;
  properties.pNext = &maintenance;
  vk_.GetPhysicalDeviceProperties2(info_.handle, &properties);
  limits_ = properties.properties.limits;
  max_allocation_bytes_ = maintenance.maxMemoryAllocationSize;
  const std::uint32_t bits = queue_families(vk_, info_.handle)[queue_family_].timestampValidBits;
  timestamp_mask_ = bits == 0 ? 0 : ~std::uint64_t{0} >> (64 - bits);
}

Context::~Context() {
  for (const RetiredFrame& retired : retired_) destroy(retired.handles);
  if (!owns_device()) return;
  vk_.DeviceWaitIdle(device_);  // Fails for a lost device, which is destroyed all the same.
  vk_.DestroySemaphore(device_, done_, vk_.allocator);
  memory_.reset();
  pipelines_.reset();
  vk_.DestroyDevice(device_, nullptr);
}

void Context::destroy(const Retired& handles) noexcept {
  vk_.DestroyFramebuffer(device_, handles.framebuffer, vk_.allocator);
  vk_.DestroyDescriptorPool(device_, handles.descriptors, vk_.allocator);
  vk_.DestroyQueryPool(device_, handles.queries, vk_.allocator);
  vk_.DestroySampler(device_, handles.sampler, vk_.allocator);
  vk_.DestroyImageView(device_, handles.view, vk_.allocator);
  vk_.DestroyImage(device_, handles.image, vk_.allocator);
  vk_.DestroyBuffer(device_, handles.buffer, vk_.allocator);
  memory_->free(handles.range);
}

void Context::retire(const Retired& handles) noexcept {
  const std::scoped_lock lock(retired_mutex_);
  if (frame_ <= completed_) {
    expected_ -= owns_device() ? 0 : 1;
    return destroy(handles);
  }
  memory_->retire(handles.range);
  retired_.push_back({frame_, handles});
}

void Context::expect_retirement() {
  if (owns_device()) return;
  const std::scoped_lock lock(retired_mutex_);
  if (retired_.capacity() < expected_ + 1) retired_.reserve(2 * (expected_ + 1));
  ++expected_;
}

RecordingId Context::begin_recording() {
  dropped_.reserve(dropped_.size() + 1);  // so that drop_recording cannot fail
  return RecordingId{++recordings_};
}

void Context::drop_recording(RecordingId recording) noexcept {
  const auto number = static_cast<std::uint64_t>(recording);
  if (!dropped_.empty() && static_cast<std::uint64_t>(dropped_.back().last) + 1 == number)
    dropped_.back().last = recording;
  else
    dropped_.push_back({recording, recording});
}

bool Context::is_in_dropped_range(RecordingId recording) const {
  const auto range = std::ranges::lower_bound(dropped_, recording, {}, &DroppedRange::last);
  return range != dropped_.end() && range->first <= recording;
}

void Context::begin_frame(std::uint64_t frame, std::uint64_t completed) {
  BRUME_ASSERT(!owns_device() && frame >= frame_ && completed < frame && completed >= completed_,
               std::to_string(frame) + ", " + std::to_string(completed));
  const std::scoped_lock lock(retired_mutex_);
  // Until the number rises: other renderers may draw the same frame.
  if (is_deferred_ && frame > frame_) {
    for (RetiredFrame& retired : retired_)
      if (retired.frame == frame_) retired.frame = frame;
    is_deferred_ = false;
  }
  frame_ = frame;
  completed_ = completed;
  const auto end =
      std::ranges::find_if(retired_, [&](const RetiredFrame& retired) { return retired.frame > completed; });
  for (auto retired = retired_.begin(); retired != end; ++retired) destroy(retired->handles);
  expected_ -= static_cast<std::size_t>(end - retired_.begin());
  retired_.erase(retired_.begin(), end);
}

void Context::submit(VkCommandBuffer commands, const WindowSemaphores& window) {
  BRUME_ASSERT(owns_device(), "a host submits its own command buffers");
  // The values of the timeline; binary semaphores have none.
  const std::uint64_t values[] = {++submitted_, 0};
  const VkSemaphore signals[] = {done_, window.signal};
  const VkPipelineStageFlags wait_stage = VK_PIPELINE_STAGE_TRANSFER_BIT;
  VkTimelineSemaphoreSubmitInfo timeline{};
  timeline.sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO;
  VkSubmitInfo submit{};
  submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  submit.pNext = &timeline;
  submit.waitSemaphoreCount = window.wait ? 1 : 0;
  submit.pWaitSemaphores = &window.wait;
  submit.pWaitDstStageMask = &wait_stage;
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands;
  submit.signalSemaphoreCount = timeline.signalSemaphoreValueCount = window.signal ? 2 : 1;
  submit.pSignalSemaphores = signals;
  timeline.pSignalSemaphoreValues = values;
  check(vk_.QueueSubmit(queue_, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
}

void Context::wait() {
  VkSemaphoreWaitInfo wait{};
  wait.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO;
  wait.semaphoreCount = 1;
  wait.pSemaphores = &done_;
  wait.pValues = &submitted_;
  const VkResult result = vk_.WaitSemaphores(device_, &wait, kWaitNanoseconds);
  if (result == VK_TIMEOUT)
    throw Error(ErrorCode::no_device, "the Vulkan device did not finish within ten minutes");
  check(result, "vkWaitSemaphores");
}

std::vector<std::string> Context::take_validation_messages() const {
  return instance_ ? instance_->take_messages() : std::vector<std::string>{};
}

}  // namespace brume::gpu
