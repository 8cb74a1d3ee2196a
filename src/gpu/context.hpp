// The device that everything runs on: our own, or a host's.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gpu/device_list.hpp"
#include "gpu/functions.hpp"
#include "gpu/instance.hpp"
#include "gpu/memory.hpp"

namespace brume::gpu {

/// What showing pictures in a window asks of instance and device.
struct Presentation {
  std::vector<const char*> instance_extensions;  ///< Of the window system.
  /// Whether a queue family of a device can show pictures.
  std::function<bool(VkInstance, VkPhysicalDevice, std::uint32_t family)> supported;
};

struct ContextOptions {
  std::string device;           ///< As choose_device takes it.
  bool validation = false;      ///< Validation and synchronization layers; their messages are kept.
  Presentation presentation{};  ///< Without extensions: no windows.
};

/// What a host lends. Everything must outlive the Context. The device needs Vulkan 1.3 with the features of
/// DeviceFeatures (device_features.hpp) enabled.
struct HostDevice {
  PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  std::uint32_t queue_family = 0;  ///< Graphics and compute. The queue itself stays the host's.
};

/// Semaphores of a submission besides the device's own: null, or what the commands wait for before they write
/// a window's image, and what is signalled when they are done.
struct WindowSemaphores {
  VkSemaphore wait = VK_NULL_HANDLE, signal = VK_NULL_HANDLE;
};

class Pipeline;

class Context {
 public:
  /// Owns its instance and device. Throws no_device when nothing fits.
  explicit Context(const ContextOptions& options);
  /// Lives on the host's device: records only, never submits or waits.
  explicit Context(const HostDevice& host);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  const Functions& vk() const { return vk_; }
  VkDevice device() const { return device_; }
  const DeviceInfo& info() const { return info_; }
  const VkPhysicalDeviceLimits& limits() const { return limits_; }
  std::uint32_t queue_family() const { return queue_family_; }
  /// Nanoseconds a timestamp tick.
  double timestamp_period() const { return static_cast<double>(limits_.timestampPeriod); }
  Memory& memory() { return *memory_; }
  const Memory& memory() const { return *memory_; }
  /// All that live on it; they enter and leave it themselves.
  std::vector<Pipeline*>& pipelines() { return pipelines_; }
  bool owns_device() const { return instance_ != nullptr; }

  // Only with a device of our own:
  VkInstance instance() const { return instance_->handle(); }
  VkQueue queue() const { return queue_; }
  /// Submits a command buffer that has ended. Throws DeviceLost.
  void submit(VkCommandBuffer commands, const WindowSemaphores& window = {});
  /// Until the device is done with all that was submitted. Throws DeviceLost.
  void wait();

  /// What the validation layers said since the last call.
  std::vector<std::string> take_validation_messages() const;

 private:
  void create_device(const Presentation& presentation);
  void read_properties();

  std::unique_ptr<Instance> instance_;  // null: the device is the host's
  Functions vk_;
  DeviceInfo info_;
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  VkSemaphore done_ = VK_NULL_HANDLE;  // timeline
  std::uint64_t submitted_ = 0;
  std::uint32_t queue_family_ = 0;
  VkPhysicalDeviceLimits limits_{};
  std::unique_ptr<Memory> memory_;
  std::vector<Pipeline*> pipelines_;
};

}  // namespace brume::gpu
