// Our own Vulkan instance, optionally with validation layers.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "gpu/functions.hpp"

namespace brume::gpu {

class Instance {
 public:
  /// With `validation`, enables the Khronos layer with synchronization checks and stores its messages.
  /// `extensions`: what the window system requires. `api_version`: the highest version of Vulkan in use.
  /// Throws no_device when the loader, a driver, or a requested layer or extension is missing.
  explicit Instance(bool validation, const std::vector<const char*>& extensions = {},
                    std::uint32_t api_version = VK_API_VERSION_1_3);
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  VkInstance handle() const { return handle_; }
  const Functions& vk() const { return vk_; }
  /// The messages of the validation layers since the last call.
  std::vector<std::string> take_messages() const;

 private:
  static VkBool32 VKAPI_PTR on_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                       VkDebugUtilsMessageTypeFlagsEXT,
                                       const VkDebugUtilsMessengerCallbackDataEXT* data, void* self);

  Functions vk_;
  VkInstance handle_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  PFN_vkDestroyDebugUtilsMessengerEXT destroy_messenger_ = nullptr;
  mutable std::mutex mutex_;
  mutable std::vector<std::string> messages_;
};

}  // namespace brume::gpu
