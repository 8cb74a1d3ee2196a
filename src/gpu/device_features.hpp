// The features that Brume requires of a Vulkan 1.3 device, for hosts that create the device themselves. It
// also requires subgroup vote, arithmetic and ballot in compute shaders, which no feature enables.
#pragma once

#include <vulkan/vulkan_core.h>

namespace brume::gpu {

/// The features as a chain for VkDeviceCreateInfo::pNext, to which a host can append its own. The chain
/// points into this object, which must not move before the device is created.
struct DeviceFeatures {
  VkPhysicalDeviceVulkan13Features vulkan13{};
  VkPhysicalDeviceVulkan12Features vulkan12{};
  VkPhysicalDeviceFeatures2 features{};

  DeviceFeatures() {
    vulkan13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    vulkan13.dynamicRendering = VK_TRUE;
    vulkan13.synchronization2 = VK_TRUE;
    vulkan12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    vulkan12.pNext = &vulkan13;
    vulkan12.timelineSemaphore = VK_TRUE;
    vulkan12.scalarBlockLayout = VK_TRUE;
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    features.pNext = &vulkan12;
    features.features.samplerAnisotropy = VK_TRUE;
    features.features.shaderStorageImageExtendedFormats = VK_TRUE;
  }
  DeviceFeatures(const DeviceFeatures&) = delete;
  DeviceFeatures& operator=(const DeviceFeatures&) = delete;

  const void* chain() const { return &features; }
};

}  // namespace brume::gpu
