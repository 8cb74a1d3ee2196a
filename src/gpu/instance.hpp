// A Vulkan instance of our own, with the validation layers on request.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "gpu/functions.hpp"

namespace brume::gpu {

class Instance {
 public:
  /// With `validation`, the Khronos layer with synchronization checks, whose messages are kept. `extensions`
  /// are those that the window system needs. Throws no_device when there is no loader, no driver or (asked
  /// for) no layer or extension.
  explicit Instance(bool validation, const std::vector<const char*>& extensions = {});
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  VkInstance handle() const { return handle_; }
  const Functions& vk() const { return vk_; }
  /// What the validation layers said since the last call.
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
