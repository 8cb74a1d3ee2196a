#include "gpu/device_features.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace brume::gpu {
namespace {

constexpr auto kFeatures2 = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
constexpr auto kVulkan12 = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
constexpr auto kVulkan13 = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
constexpr std::size_t kOfSingle = offsetof(FeatureStructs::Single, enabled);
static_assert(sizeof(FeatureStructs::Single) == sizeof(VkPhysicalDeviceDynamicRenderingFeatures) &&
              kOfSingle == offsetof(VkPhysicalDeviceDynamicRenderingFeatures, dynamicRendering) &&
              kOfSingle == offsetof(VkPhysicalDeviceSynchronization2Features, synchronization2));

// docs/reference/c-api.md, "Vulkan device features", says what each is for.
constexpr Feature kFeatures[] = {
    {"shaderStorageImageExtendedFormats",
     {kFeatures2, offsetof(VkPhysicalDeviceFeatures2, features.shaderStorageImageExtendedFormats)}},
    {"samplerAnisotropy", {kFeatures2, offsetof(VkPhysicalDeviceFeatures2, features.samplerAnisotropy)}},
    {"dynamicRendering",
     {kVulkan13, offsetof(VkPhysicalDeviceVulkan13Features, dynamicRendering)},
     {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES, kOfSingle}},
    {"synchronization2",
     {kVulkan13, offsetof(VkPhysicalDeviceVulkan13Features, synchronization2)},
     {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES, kOfSingle}}};
constexpr std::size_t kRequiredCount = 1;
static_assert(std::size(kFeatures) <= std::tuple_size_v<decltype(FeatureStructs::singles)>);

/// The structs of a chain, in order.
Result<std::vector<VkBaseOutStructure*>> structs_of(void* chain) {
  constexpr std::size_t kMostStructs = 1024;
  std::vector<VkBaseOutStructure*> structs;
  for (auto* each = static_cast<VkBaseOutStructure*>(chain); each; each = each->pNext) {
    if (structs.size() == kMostStructs)
      return Failure{ErrorCode::usage, "the chain has more than 1024 structs, or is a circle"};
    structs.push_back(each);
  }
  if (std::ranges::find(structs, kFeatures2, &VkBaseOutStructure::sType) == structs.end())
    return Failure{ErrorCode::usage, "the chain has no VkPhysicalDeviceFeatures2"};
  return structs;
}

/// Its place in a struct of a chain; null: the struct has no such member.
VkBool32* find(const Feature& feature, VkBaseOutStructure* holder) {
  for (const FeatureMember& member : {feature.of_version, feature.alone})
    if (member.offset > 0 && member.type == holder->sType)
      return reinterpret_cast<VkBool32*>(reinterpret_cast<std::byte*>(holder) + member.offset);
  return nullptr;
}

bool is_set(const Feature& feature, std::span<VkBaseOutStructure* const> structs) {
  return std::ranges::any_of(structs, [&](VkBaseOutStructure* each) {
    const VkBool32* const member = find(feature, each);
    return member && *member;
  });
}

}  // namespace

std::span<const Feature> required_features() {
  return features().first(kRequiredCount);
}

std::span<const Feature> optional_features() {
  return features().subspan(kRequiredCount);
}

std::span<const Feature> features() {
  return kFeatures;
}

DeviceFeatures::DeviceFeatures(VkBool32 enabled) {
  vulkan13.sType = kVulkan13;
  vulkan12.sType = kVulkan12;
  vulkan12.pNext = &vulkan13;
  features.sType = kFeatures2;
  features.pNext = &vulkan12;
  for (const Feature& feature : kFeatures)
    for (auto* each = reinterpret_cast<VkBaseOutStructure*>(&features); each; each = each->pNext)
      if (VkBool32* const member = find(feature, each)) *member = enabled;
}

Result<const Feature*> first_missing(const void* chain, std::span<const Feature> wanted) {
  const auto structs = structs_of(const_cast<void*>(chain));
  if (!structs) return structs.failure();
  const auto missing = std::ranges::find_if(wanted, [&](const Feature& f) { return !is_set(f, *structs); });
  return missing == wanted.end() ? nullptr : &*missing;
}

Result<OptionalFeatures> optional_features_of(const void* chain) {
  const auto structs = structs_of(const_cast<void*>(chain));
  if (!structs) return structs.failure();
  const auto optional = optional_features();
  return OptionalFeatures{is_set(optional[0], *structs), is_set(optional[1], *structs),
                          is_set(optional[2], *structs)};
}

Result<void> merge_features(void* chain, FeatureStructs& structs) {
  const auto given = structs_of(chain);
  if (!given) return given.failure();
  structs = {};
  auto free = structs.singles.begin();
  VkBaseOutStructure* last = given->back();
  for (const Feature& feature : kFeatures) {
    bool is_set = false;
    for (VkBaseOutStructure* const each : *given) {
      VkBool32* const member = find(feature, each);
      if (member) *member = VK_TRUE;
      is_set |= member != nullptr;
    }
    if (is_set) continue;
    *free = {feature.alone.type, nullptr, VK_TRUE};
    last->pNext = reinterpret_cast<VkBaseOutStructure*>(&*free++);
    last = last->pNext;
  }
  return {};
}

}  // namespace brume::gpu
