// The features that Godot 4 enables of a device of Vulkan 1.2.
#pragma once

#include "gpu/functions.hpp"

namespace brume::gpu {

inline constexpr VkBool32 VkPhysicalDeviceFeatures::*kFeaturesOfGodot[] = {
    &VkPhysicalDeviceFeatures::fullDrawIndexUint32,
    &VkPhysicalDeviceFeatures::imageCubeArray,
    &VkPhysicalDeviceFeatures::independentBlend,
    &VkPhysicalDeviceFeatures::geometryShader,
    &VkPhysicalDeviceFeatures::tessellationShader,
    &VkPhysicalDeviceFeatures::sampleRateShading,
    &VkPhysicalDeviceFeatures::dualSrcBlend,
    &VkPhysicalDeviceFeatures::logicOp,
    &VkPhysicalDeviceFeatures::multiDrawIndirect,
    &VkPhysicalDeviceFeatures::drawIndirectFirstInstance,
    &VkPhysicalDeviceFeatures::depthClamp,
    &VkPhysicalDeviceFeatures::depthBiasClamp,
    &VkPhysicalDeviceFeatures::fillModeNonSolid,
    &VkPhysicalDeviceFeatures::depthBounds,
    &VkPhysicalDeviceFeatures::wideLines,
    &VkPhysicalDeviceFeatures::largePoints,
    &VkPhysicalDeviceFeatures::alphaToOne,
    &VkPhysicalDeviceFeatures::multiViewport,
    &VkPhysicalDeviceFeatures::samplerAnisotropy,
    &VkPhysicalDeviceFeatures::textureCompressionETC2,
    &VkPhysicalDeviceFeatures::textureCompressionASTC_LDR,
    &VkPhysicalDeviceFeatures::textureCompressionBC,
    &VkPhysicalDeviceFeatures::vertexPipelineStoresAndAtomics,
    &VkPhysicalDeviceFeatures::fragmentStoresAndAtomics,
    &VkPhysicalDeviceFeatures::shaderTessellationAndGeometryPointSize,
    &VkPhysicalDeviceFeatures::shaderImageGatherExtended,
    &VkPhysicalDeviceFeatures::shaderStorageImageExtendedFormats,
    &VkPhysicalDeviceFeatures::shaderStorageImageReadWithoutFormat,
    &VkPhysicalDeviceFeatures::shaderStorageImageWriteWithoutFormat,
    &VkPhysicalDeviceFeatures::shaderUniformBufferArrayDynamicIndexing,
    &VkPhysicalDeviceFeatures::shaderSampledImageArrayDynamicIndexing,
    &VkPhysicalDeviceFeatures::shaderStorageBufferArrayDynamicIndexing,
    &VkPhysicalDeviceFeatures::shaderStorageImageArrayDynamicIndexing,
    &VkPhysicalDeviceFeatures::shaderClipDistance,
    &VkPhysicalDeviceFeatures::shaderCullDistance,
    &VkPhysicalDeviceFeatures::shaderFloat64,
    &VkPhysicalDeviceFeatures::shaderInt64,
    &VkPhysicalDeviceFeatures::shaderInt16,
    &VkPhysicalDeviceFeatures::shaderResourceMinLod,
    &VkPhysicalDeviceFeatures::variableMultisampleRate};

inline constexpr VkBool32 VkPhysicalDeviceVulkan11Features::*kVulkan11FeaturesOfGodot[] = {
    &VkPhysicalDeviceVulkan11Features::storageBuffer16BitAccess,
    &VkPhysicalDeviceVulkan11Features::uniformAndStorageBuffer16BitAccess,
    &VkPhysicalDeviceVulkan11Features::storagePushConstant16,
    &VkPhysicalDeviceVulkan11Features::storageInputOutput16,
    &VkPhysicalDeviceVulkan11Features::multiview,
    &VkPhysicalDeviceVulkan11Features::multiviewGeometryShader,
    &VkPhysicalDeviceVulkan11Features::multiviewTessellationShader};

/// It enables them by structs of their own.
inline constexpr VkBool32 VkPhysicalDeviceVulkan12Features::*kVulkan12FeaturesOfGodot[] = {
    &VkPhysicalDeviceVulkan12Features::shaderFloat16, &VkPhysicalDeviceVulkan12Features::shaderInt8,
    &VkPhysicalDeviceVulkan12Features::bufferDeviceAddress,
    &VkPhysicalDeviceVulkan12Features::vulkanMemoryModel,
    &VkPhysicalDeviceVulkan12Features::vulkanMemoryModelDeviceScope};

/// Enables those that the physical device has.
inline void enable_as_godot(const Functions& vk, VkPhysicalDevice device, VkPhysicalDeviceFeatures& features,
                            VkPhysicalDeviceVulkan11Features& vulkan11,
                            VkPhysicalDeviceVulkan12Features& vulkan12) {
  VkPhysicalDeviceVulkan12Features supported12{};
  supported12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  VkPhysicalDeviceVulkan11Features supported11{};
  supported11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES;
  supported11.pNext = &supported12;
  VkPhysicalDeviceFeatures2 supported{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &supported11, {}};
  vk.GetPhysicalDeviceFeatures2(device, &supported);
  for (const auto feature : kFeaturesOfGodot) features.*feature = supported.features.*feature;
  for (const auto feature : kVulkan11FeaturesOfGodot) vulkan11.*feature = supported11.*feature;
  for (const auto feature : kVulkan12FeaturesOfGodot) vulkan12.*feature = supported12.*feature;
}

}  // namespace brume::gpu
