// The device that everything runs on: our own, or a host's.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gpu/device_list.hpp"
#include "gpu/functions.hpp"
#include "gpu/instance.hpp"
#include "gpu/memory.hpp"

namespace brume::gpu {

struct ContextOptions {
  std::string device;       ///< As choose_device takes it.
  bool validation = false;  ///< Validation and synchronization layers; their messages are kept.
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
  bool owns_device() const { return instance_ != nullptr; }

  /// Submits a command buffer that has ended, and waits until the device is done with it. Only with a device
  /// of our own. Throws no_device when the device is lost.
  void submit_and_wait(VkCommandBuffer commands);

  /// What the validation layers said since the last call.
  std::vector<std::string> take_validation_messages() const;

 private:
  void create_device();
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
};

}  // namespace brume::gpu
