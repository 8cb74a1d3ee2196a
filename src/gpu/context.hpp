// The Vulkan device that everything runs on: our own, or a host application's.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "gpu/device_list.hpp"
#include "gpu/functions.hpp"
#include "gpu/instance.hpp"
#include "gpu/memory.hpp"
#include "gpu/pipeline_store.hpp"
#include "gpu/tuning.hpp"

namespace brume::gpu {

/// Requirements on instance and device for presenting in a window.
struct Presentation {
  std::vector<const char*> instance_extensions;  ///< Required by the window system.
  /// Whether a queue family of a device can present.
  std::function<bool(VkInstance, VkPhysicalDevice, std::uint32_t family)> supported;
};

struct ContextOptions {
  std::string device;  ///< See choose_device.
  /// Enables validation and synchronization layers, stores their messages, and fills new memory
  /// (gpu::Memory).
  bool validation = false;
  Presentation presentation{};  ///< Without extensions: no windows.
};

/// Handles lent by a host, which must outlive the Context. The device must support Vulkan 1.2 and have the
/// required_features() enabled.
struct HostDevice {
  PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  std::uint32_t queue_family = 0;  ///< With graphics and compute. The queue itself remains the host's.
  MemoryCallbacks memory{};
  /// The chain with which the device was created, read by the constructor; null: one of all features() that
  /// the physical device supports, not checked.
  const void* enabled_features = nullptr;
  VkPipelineCache pipeline_cache = VK_NULL_HANDLE;  ///< For the driver's compilations; null: none.
  /// Memory of the CPU for the driver; null: its own.
  const VkAllocationCallbacks* allocator = nullptr;
};

/// Additional semaphores of a submission: null, or one to wait for before writing a window's image, and one
/// to signal when the commands are complete.
struct WindowSemaphores {
  VkSemaphore wait = VK_NULL_HANDLE, signal = VK_NULL_HANDLE;
};

/// A recording of a context. RecordingId{} stands for none.
enum class RecordingId : std::uint64_t {};

/// Handles that are no longer used by commands yet to be recorded; null: none.
struct Retired {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkImage image = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  VkSampler sampler = VK_NULL_HANDLE;
  VkFramebuffer framebuffer = VK_NULL_HANDLE;
  VkDescriptorPool descriptors = VK_NULL_HANDLE;
  VkQueryPool queries = VK_NULL_HANDLE;
  Memory::Range range = {};
};

class Context {
 public:
  /// Creates its own instance and device. Throws no_device when no device fits.
  explicit Context(const ContextOptions& options);
  /// Uses the host's device: records only, never submits or waits. Throws no_device when device or driver
  /// lack something, and usage for another queue family. `pipelines_of`: a context of the same device, which
  /// must outlive this one, to share its pipelines; each of both may be used by a thread of its own.
  explicit Context(const HostDevice& host, Context* pipelines_of = nullptr);
  /// The device has completed all that was recorded.
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  const Functions& vk() const { return vk_; }
  VkDevice device() const { return device_; }
  const DeviceInfo& info() const { return info_; }
  const Tuning& tuning() const { return tuning_; }
  const VkPhysicalDeviceLimits& limits() const { return limits_; }
  /// The largest allocation of memory that the device promises.
  std::uint64_t max_allocation_bytes() const { return max_allocation_bytes_; }
  std::uint32_t queue_family() const { return queue_family_; }
  /// Nanoseconds per timestamp tick.
  double timestamp_period() const { return static_cast<double>(limits_.timestampPeriod); }
  /// The bits of a timestamp that are valid; 0: the queue family has no timestamps.
  std::uint64_t timestamp_mask() const { return timestamp_mask_; }
  Memory& memory() { return *memory_; }
  const Memory& memory() const { return *memory_; }
  /// The pipelines of the device.
  PipelineStore& pipelines() { return *pipelines_; }
  bool owns_device() const { return instance_ != nullptr; }

  /// Destroys handles once the device has completed the frames that were begun before: at once on a device of
  /// our own, whose programs wait before they destroy.
  void retire(const Retired& handles) noexcept;
  /// Before something is created that `retire` takes: makes room, so that `retire` cannot fail.
  void expect_retirement();
  /// A host begins to record a frame; the device has completed all frames up to `completed`. Frames rise.
  void begin_frame(std::uint64_t frame, std::uint64_t completed);
  /// Commands of the present frame will be recorded with the next one: what was retired since this frame
  /// began is destroyed no earlier than after that.
  void defer_frame() noexcept { is_deferred_ = true; }

  /// Commands are collected, to be executed together or not at all.
  RecordingId begin_recording();
  /// They will not be executed: see Recorded.
  void drop_recording(RecordingId recording) noexcept;
  bool is_dropped(RecordingId recording) const { return !dropped_.empty() && is_in_dropped_range(recording); }

  // Only when owns_device():
  VkInstance instance() const { return instance_->handle(); }
  VkQueue queue() const { return queue_; }
  /// Submits a completed command buffer. Throws DeviceLost.
  void submit(VkCommandBuffer commands, const WindowSemaphores& window = {});
  /// Waits until the device has completed all submissions. Throws DeviceLost.
  void wait();

  /// The messages of the validation layers since the last call.
  std::vector<std::string> take_validation_messages() const;

 private:
  void create_device(const Presentation& presentation);
  void read_properties();
  void destroy(const Retired& handles) noexcept;
  bool is_in_dropped_range(RecordingId recording) const;

  std::unique_ptr<Instance> instance_;  // null: the device is the host's
  Functions vk_;
  OptionalFeatures enabled_;  // features of a host's device
  DeviceInfo info_;
  Tuning tuning_;
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  VkSemaphore done_ = VK_NULL_HANDLE;  // timeline
  std::uint64_t submitted_ = 0;
  std::uint32_t queue_family_ = 0;
  VkPhysicalDeviceLimits limits_{};
  std::uint64_t max_allocation_bytes_ = 0;
  std::uint64_t timestamp_mask_ = 0;
  std::unique_ptr<Memory> memory_;
  std::shared_ptr<PipelineStore> pipelines_;

  /// Recordings one after the other that were dropped.
  struct DroppedRange {
    RecordingId first, last;
  };
  std::uint64_t recordings_ = 0;
  std::vector<DroppedRange> dropped_;  // rising

  // On a host's device, handles outlive the frames that use them.
  bool is_deferred_ = false;
  struct RetiredFrame {
    std::uint64_t frame;
    Retired handles;
  };
  std::mutex retired_mutex_;
  std::uint64_t frame_ = 0, completed_ = 0;
  std::vector<RetiredFrame> retired_;  // frames rising
  std::size_t expected_ = 0;           // handles that may be retired
};

}  // namespace brume::gpu
