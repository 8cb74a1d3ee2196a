#include "gpu/instance.hpp"

#include <utility>

#include "core/error.hpp"

namespace brume::gpu {

VkBool32 VKAPI_PTR Instance::on_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                        VkDebugUtilsMessageTypeFlagsEXT,
                                        const VkDebugUtilsMessengerCallbackDataEXT* data, void* self) {
  const auto* instance = static_cast<const Instance*>(self);
  const std::lock_guard lock(instance->mutex_);
  instance->messages_.emplace_back(data->pMessage ? data->pMessage : "(no text)");
  return VK_FALSE;
}

Instance::Instance(bool validation, const std::vector<const char*>& wanted, std::uint32_t api_version) {
  const auto get = system_loader();
  const auto create = reinterpret_cast<PFN_vkCreateInstance>(get(nullptr, "vkCreateInstance"));
  if (!create)
    throw Error(ErrorCode::no_device, "the Vulkan loader has no vkCreateInstance; reinstall libvulkan1");

  // The validation layer and its messages.
  const VkApplicationInfo application{
      VK_STRUCTURE_TYPE_APPLICATION_INFO, nullptr, "brume", 1, "brume", 1, api_version};
  const VkValidationFeatureEnableEXT enabled[] = {
      VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
  const VkDebugUtilsMessengerCreateInfoEXT messenger{
      VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
      nullptr,
      0,
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
      VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
      on_message,
      this};
  const VkValidationFeaturesEXT features{
      VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT, &messenger, 1, enabled, 0, nullptr};

  // The instance.
  const char* const layers[] = {"VK_LAYER_KHRONOS_validation"};
  std::vector<const char*> extensions = wanted;
  if (validation) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  VkInstanceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
  info.pApplicationInfo = &application;
  if (validation) {
    info.pNext = &features;
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = layers;
  }
  info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  const VkResult result = create(&info, nullptr, &handle_);
  if (result == VK_ERROR_EXTENSION_NOT_PRESENT && !wanted.empty()) {
    throw Error(ErrorCode::no_device, "the Vulkan loader does not support this window system");
  }
  if (result == VK_ERROR_LAYER_NOT_PRESENT || result == VK_ERROR_EXTENSION_NOT_PRESENT) {
    throw Error(ErrorCode::no_device, "no Vulkan validation layer; install vulkan-validationlayers");
  }
  if (result == VK_ERROR_INCOMPATIBLE_DRIVER) {
    throw Error(ErrorCode::no_device,
                "no Vulkan device; install a driver (mesa-vulkan-drivers renders on any CPU)");
  }
  check(result, "vkCreateInstance");
  // Its functions.
  vk_.load_instance(get, handle_);
  if (!wanted.empty()) vk_.load_surface(get, handle_);
  if (!validation) return;
  const auto create_messenger =
      reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(get(handle_, "vkCreateDebugUtilsMessengerEXT"));
  destroy_messenger_ =
      reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(get(handle_, "vkDestroyDebugUtilsMessengerEXT"));
  check(create_messenger(handle_, &messenger, nullptr, &messenger_), "vkCreateDebugUtilsMessengerEXT");
}

Instance::~Instance() {
  if (messenger_) destroy_messenger_(handle_, messenger_, nullptr);
  vk_.DestroyInstance(handle_, nullptr);
}

std::vector<std::string> Instance::take_messages() const {
  const std::lock_guard lock(mutex_);
  return std::exchange(messages_, {});
}

}  // namespace brume::gpu
