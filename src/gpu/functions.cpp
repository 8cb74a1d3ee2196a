#include "gpu/functions.hpp"

#include <string>

#include "core/error.hpp"
#include "core/platform/library.hpp"

namespace brume::gpu {
namespace {

[[noreturn]] void missing(const char* name) {
  throw Error(ErrorCode::no_device,
              std::string("vk") + name + " is missing: driver and instance must be of Vulkan 1.2");
}

}  // namespace

void Functions::load_instance(PFN_vkGetInstanceProcAddr get, VkInstance instance) {
#define X(name)                                                     \
  name = reinterpret_cast<PFN_vk##name>(get(instance, "vk" #name)); \
  if (!name) missing(#name);
  BRUME_VK_INSTANCE_FUNCTIONS(X)
#undef X
#define X(name) name = reinterpret_cast<PFN_vk##name>(get(instance, "vk" #name));
  BRUME_VK_DEBUG_FUNCTIONS(X)
#undef X
}

void Functions::load_device(VkDevice device, const OptionalFeatures& optional) {
#define X(name)                                                                 \
  name = reinterpret_cast<PFN_vk##name>(GetDeviceProcAddr(device, "vk" #name)); \
  if (!name) missing(#name);
  BRUME_VK_DEVICE_FUNCTIONS(X)
#undef X
#define X(name) name = reinterpret_cast<PFN_vk##name>(GetDeviceProcAddr(device, "vk" #name));
  BRUME_VK_OPTIONAL_FUNCTIONS(X)
#undef X
  // A loader may have functions of a version that the device was not created for.
  if (!optional.synchronization2) CmdPipelineBarrier2 = nullptr;
  if (!optional.dynamic_rendering) CmdBeginRendering = nullptr, CmdEndRendering = nullptr;
}

void Functions::load_surface(PFN_vkGetInstanceProcAddr get, VkInstance instance) {
#define X(name)                                                     \
  name = reinterpret_cast<PFN_vk##name>(get(instance, "vk" #name)); \
  if (!name) missing(#name);
  BRUME_VK_SURFACE_FUNCTIONS(X)
#undef X
}

void Functions::load_swapchain(VkDevice device) {
#define X(name)                                                                 \
  name = reinterpret_cast<PFN_vk##name>(GetDeviceProcAddr(device, "vk" #name)); \
  if (!name) missing(#name);
  BRUME_VK_SWAPCHAIN_FUNCTIONS(X)
#undef X
}

PFN_vkGetInstanceProcAddr system_loader() {
  // Never closed: drivers do not support being unloaded.
  const auto& [file, install] = platform::kVulkanLoader;
  static void* const library = platform::load_library(file);
  if (!library) {
    throw Error(ErrorCode::no_device, std::string("no Vulkan loader (") + file + "); install " + install +
                                          " and a driver such as mesa-vulkan-drivers");
  }
  const auto get =
      reinterpret_cast<PFN_vkGetInstanceProcAddr>(platform::find_symbol(library, "vkGetInstanceProcAddr"));
  if (!get)
    throw Error(ErrorCode::no_device,
                std::string(file) + " has no vkGetInstanceProcAddr; reinstall " + install);
  return get;
}

const char* result_name(VkResult result) {
  // The results that functions which are loaded here are known to return.
  switch (result) {
    case VK_SUCCESS:
      return "VK_SUCCESS";
    case VK_TIMEOUT:
      return "VK_TIMEOUT";
    case VK_ERROR_OUT_OF_HOST_MEMORY:
      return "VK_ERROR_OUT_OF_HOST_MEMORY";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
      return "VK_ERROR_OUT_OF_DEVICE_MEMORY";
    case VK_ERROR_INITIALIZATION_FAILED:
      return "VK_ERROR_INITIALIZATION_FAILED";
    case VK_ERROR_DEVICE_LOST:
      return "VK_ERROR_DEVICE_LOST";
    case VK_ERROR_MEMORY_MAP_FAILED:
      return "VK_ERROR_MEMORY_MAP_FAILED";
    case VK_ERROR_LAYER_NOT_PRESENT:
      return "VK_ERROR_LAYER_NOT_PRESENT";
    case VK_ERROR_EXTENSION_NOT_PRESENT:
      return "VK_ERROR_EXTENSION_NOT_PRESENT";
    case VK_ERROR_FEATURE_NOT_PRESENT:
      return "VK_ERROR_FEATURE_NOT_PRESENT";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
      return "VK_ERROR_INCOMPATIBLE_DRIVER";
    case VK_ERROR_TOO_MANY_OBJECTS:
      return "VK_ERROR_TOO_MANY_OBJECTS";
    case VK_ERROR_FORMAT_NOT_SUPPORTED:
      return "VK_ERROR_FORMAT_NOT_SUPPORTED";
    case VK_ERROR_OUT_OF_POOL_MEMORY:
      return "VK_ERROR_OUT_OF_POOL_MEMORY";
    case VK_ERROR_SURFACE_LOST_KHR:
      return "VK_ERROR_SURFACE_LOST_KHR";
    case VK_ERROR_NATIVE_WINDOW_IN_USE_KHR:
      return "VK_ERROR_NATIVE_WINDOW_IN_USE_KHR";
    case VK_ERROR_OUT_OF_DATE_KHR:
      return "VK_ERROR_OUT_OF_DATE_KHR";
    default:
      return "an unnamed VkResult";
  }
}

void check(VkResult result, const char* what) {
  if (result == VK_SUCCESS) return;
  const bool memory = result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY ||
                      result == VK_ERROR_OUT_OF_POOL_MEMORY || result == VK_ERROR_TOO_MANY_OBJECTS;
  const bool device = result == VK_ERROR_INCOMPATIBLE_DRIVER || result == VK_ERROR_INITIALIZATION_FAILED;
  const std::string message = std::string(what) + " failed with " + result_name(result) + " (" +
                              std::to_string(result) + ")" +
                              (memory ? "; a smaller image or grid needs less memory" : "");
  if (result == VK_ERROR_DEVICE_LOST) throw DeviceLost(ErrorCode::no_device, message);
  throw Error(memory   ? ErrorCode::resource_limit
              : device ? ErrorCode::no_device
                       : ErrorCode::internal,
              message);
}

}  // namespace brume::gpu
