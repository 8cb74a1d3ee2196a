// The features that Brume uses of a Vulkan device, for hosts that create the device themselves. It also
// requires subgroup vote, arithmetic and ballot in compute shaders, which no feature enables.
#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstddef>
#include <span>

#include "core/error.hpp"

namespace brume::gpu {

/// A VkBool32 in a struct of a chain.
struct FeatureMember {
  VkStructureType type;
  std::size_t offset;
};

struct Feature {
  const char* name;
  FeatureMember of_version;  ///< In the struct of all features of a version of Vulkan.
  /// In the struct of this feature alone; offset 0: there is none.
  FeatureMember alone = {};
};

/// The features that a host's device needs.
std::span<const Feature> required_features();
/// What Brume does without where a host's device lacks it.
std::span<const Feature> optional_features();
/// Both, the required ones first. Devices of our own have timelineSemaphore in addition, which every device
/// of Vulkan 1.2 supports.
std::span<const Feature> features();

/// The optional features that a device has enabled.
struct OptionalFeatures {
  bool sampler_anisotropy = true;
  bool dynamic_rendering = true;
  bool synchronization2 = true;
};

/// The features as a chain for VkDeviceCreateInfo::pNext, to which a host can append its own. The chain
/// points into this object, which must not move before the device is created.
struct DeviceFeatures {
  VkPhysicalDeviceVulkan13Features vulkan13{};
  VkPhysicalDeviceVulkan12Features vulkan12{};
  VkPhysicalDeviceFeatures2 features{};

  /// All of features() are set, or none.
  explicit DeviceFeatures(VkBool32 enabled = VK_TRUE);
  DeviceFeatures(const DeviceFeatures&) = delete;
  DeviceFeatures& operator=(const DeviceFeatures&) = delete;

  const void* chain() const { return &features; }
};

/// The first of these features that no struct of a chain sets; null: all are set. Fails for a chain without
/// VkPhysicalDeviceFeatures2, and for a circle.
Result<const Feature*> first_missing(const void* chain, std::span<const Feature> wanted);
/// The optional features that a chain sets. Fails as first_missing.
Result<OptionalFeatures> optional_features_of(const void* chain);

/// Structs of single features.
struct FeatureStructs {
  struct Single {
    VkStructureType type;
    void* next;
    VkBool32 enabled;
  };
  std::array<Single, 8> singles;
};

/// Sets all of features() in a chain. For each feature that no struct of the chain has, appends the
/// struct of that feature alone, which lies in `structs`: Vulkan allows it beside all structs but the one of
/// its version, which would have the feature. Fails as first_missing; the chain is then unchanged.
Result<void> merge_features(void* chain, FeatureStructs& structs);

}  // namespace brume::gpu
