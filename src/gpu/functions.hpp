// A private table of the Vulkan functions in use. Nothing defines or calls a global vk* symbol, so that the
// library can live in a process whose host links the loader, and tests can replace an entry.
#pragma once

#define VK_NO_PROTOTYPES
#include <vulkan/vulkan.h>

#include "core/error.hpp"
#include "gpu/device_features.hpp"

// clang-format off
#define BRUME_VK_INSTANCE_FUNCTIONS(X) \
  X(DestroyInstance) X(EnumeratePhysicalDevices) X(GetPhysicalDeviceProperties2) X(GetPhysicalDeviceFeatures2) \
  X(GetPhysicalDeviceMemoryProperties) X(GetPhysicalDeviceQueueFamilyProperties) X(CreateDevice) X(GetDeviceProcAddr) \
  X(GetPhysicalDeviceFormatProperties)

#define BRUME_VK_DEVICE_FUNCTIONS(X) \
  X(DestroyDevice) X(GetDeviceQueue) X(QueueSubmit) X(DeviceWaitIdle) \
  X(AllocateMemory) X(FreeMemory) X(MapMemory) \
  X(CreateBuffer) X(DestroyBuffer) X(GetBufferMemoryRequirements) X(BindBufferMemory) \
  X(CreateImage) X(DestroyImage) X(GetImageMemoryRequirements) X(BindImageMemory) \
  X(CreateImageView) X(DestroyImageView) X(CreateSampler) X(DestroySampler) \
  X(CreateShaderModule) X(DestroyShaderModule) X(CreateDescriptorSetLayout) X(DestroyDescriptorSetLayout) \
  X(CreatePipelineLayout) X(DestroyPipelineLayout) X(CreateComputePipelines) X(CreateGraphicsPipelines) \
  X(DestroyPipeline) X(CreateDescriptorPool) X(DestroyDescriptorPool) X(ResetDescriptorPool) \
  X(AllocateDescriptorSets) X(UpdateDescriptorSets) \
  X(CreateCommandPool) X(DestroyCommandPool) X(ResetCommandPool) X(AllocateCommandBuffers) \
  X(BeginCommandBuffer) X(EndCommandBuffer) X(CreateSemaphore) X(DestroySemaphore) X(WaitSemaphores) \
  X(CreateQueryPool) X(DestroyQueryPool) X(GetQueryPoolResults) \
  X(CmdBindPipeline) X(CmdBindDescriptorSets) X(CmdPushConstants) X(CmdDispatch) X(CmdDispatchIndirect) \
  X(CmdPipelineBarrier) X(CreateRenderPass) X(DestroyRenderPass) X(CreateFramebuffer) X(DestroyFramebuffer) \
  X(CmdCopyBuffer) X(CmdCopyBufferToImage) X(CmdCopyImageToBuffer) X(CmdUpdateBuffer) X(CmdFillBuffer) \
  X(CmdClearColorImage) X(CmdBlitImage) X(CmdBeginRenderPass) X(CmdEndRenderPass) X(CmdSetViewport) X(CmdSetScissor) \
  X(CmdBindIndexBuffer) X(CmdDrawIndexed) X(CmdDraw) X(CmdResetQueryPool) X(CmdWriteTimestamp)

// Null unless the device has OptionalFeatures::synchronization2, or dynamic_rendering.
#define BRUME_VK_OPTIONAL_FUNCTIONS(X) X(CmdPipelineBarrier2) X(CmdBeginRendering) X(CmdEndRendering)

// Names for debuggers; null unless the instance has VK_EXT_debug_utils.
#define BRUME_VK_DEBUG_FUNCTIONS(X) \
  X(SetDebugUtilsObjectNameEXT) X(CmdBeginDebugUtilsLabelEXT) X(CmdEndDebugUtilsLabelEXT)

// Only for presentation in a window.
#define BRUME_VK_SURFACE_FUNCTIONS(X) \
  X(DestroySurfaceKHR) X(GetPhysicalDeviceSurfaceCapabilitiesKHR) X(GetPhysicalDeviceSurfaceFormatsKHR) \
  X(GetPhysicalDeviceSurfacePresentModesKHR)

#define BRUME_VK_SWAPCHAIN_FUNCTIONS(X) \
  X(CreateSwapchainKHR) X(DestroySwapchainKHR) X(GetSwapchainImagesKHR) X(AcquireNextImageKHR) X(QueuePresentKHR)
// clang-format on

namespace brume::gpu {

struct Functions {
#define X(name) PFN_vk##name name = nullptr;
  BRUME_VK_INSTANCE_FUNCTIONS(X)
  BRUME_VK_DEVICE_FUNCTIONS(X)
  BRUME_VK_OPTIONAL_FUNCTIONS(X)
  BRUME_VK_DEBUG_FUNCTIONS(X)
  BRUME_VK_SURFACE_FUNCTIONS(X)
  BRUME_VK_SWAPCHAIN_FUNCTIONS(X)
#undef X
  /// The last argument of functions that create, and of those that destroy; null: the driver's own.
  const VkAllocationCallbacks* allocator = nullptr;

  /// Throws no_device when a function is missing.
  void load_instance(PFN_vkGetInstanceProcAddr get, VkInstance instance);
  void load_device(VkDevice device, const OptionalFeatures& optional = {});
  /// The same for the functions of presentation.
  void load_surface(PFN_vkGetInstanceProcAddr get, VkInstance instance);
  void load_swapchain(VkDevice device);
};

/// vkGetInstanceProcAddr of the system's loader. Throws no_device when there is none.
PFN_vkGetInstanceProcAddr system_loader();

/// "VK_ERROR_DEVICE_LOST" and so on.
const char* result_name(VkResult result);

/// The device is lost together with all its resources; a new one may be created.
class DeviceLost : public Error {
 public:
  using Error::Error;
};

/// Throws Error with a matching code when `result` is not VK_SUCCESS, DeviceLost for a lost device; `what`
/// names the failed call.
void check(VkResult result, const char* what);

}  // namespace brume::gpu
