#include "gpu/device_list.hpp"

#include <algorithm>
#include <cctype>

#include "core/error.hpp"
#include "gpu/instance.hpp"

namespace brume::gpu {
namespace {

DeviceKind kind_of(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return DeviceKind::discrete;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return DeviceKind::integrated;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return DeviceKind::virtual_gpu;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return DeviceKind::cpu;
    default:
      return DeviceKind::other;
  }
}

std::string missing_feature(const Functions& vk, VkPhysicalDevice device, std::uint32_t api_version,
                            const DeviceNeeds& needs) {
  if (api_version < needs.api_version)
    return "supports only Vulkan versions before 1." +
           std::to_string(VK_API_VERSION_MINOR(needs.api_version));

  DeviceFeatures supported(VK_FALSE);
  vk.GetPhysicalDeviceFeatures2(device, &supported.features);
  if (const Feature* const missing = *first_missing(supported.chain(), needs.features))
    return std::string("lacks ") + missing->name;

  // Operations of subgroups.
  VkPhysicalDeviceSubgroupProperties subgroups{};
  subgroups.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES;
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &subgroups, {}};
  vk.GetPhysicalDeviceProperties2(device, &properties);
  constexpr VkSubgroupFeatureFlags kOperations =
      VK_SUBGROUP_FEATURE_VOTE_BIT | VK_SUBGROUP_FEATURE_ARITHMETIC_BIT | VK_SUBGROUP_FEATURE_BALLOT_BIT;
  if (!(subgroups.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) ||
      (subgroups.supportedOperations & kOperations) != kOperations)
    return "lacks subgroup vote, arithmetic or ballot in compute shaders";
  return "";
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

int speed_rank(const DeviceInfo& device) {
  if (!device.unsupported.empty()) return 0;
  return 1 + static_cast<int>(device.kind);
}

}  // namespace

const char* name_of(DeviceKind kind) {
  switch (kind) {
    case DeviceKind::discrete:
      return "discrete";
    case DeviceKind::integrated:
      return "integrated";
    case DeviceKind::virtual_gpu:
      return "virtual";
    case DeviceKind::cpu:
      return "cpu";
    case DeviceKind::other:
      break;
  }
  return "other";
}

std::vector<DeviceInfo> list_devices(const Functions& vk, VkInstance instance, const DeviceNeeds& needs) {
  std::uint32_t count = 0;
  check(vk.EnumeratePhysicalDevices(instance, &count, nullptr), "vkEnumeratePhysicalDevices");
  std::vector<VkPhysicalDevice> handles(count);
  check(vk.EnumeratePhysicalDevices(instance, &count, handles.data()), "vkEnumeratePhysicalDevices");

  std::vector<DeviceInfo> devices;
  for (const VkPhysicalDevice handle : handles) {
    // Driver, memory and features of each device.
    VkPhysicalDeviceDriverProperties driver{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES, nullptr, {}, {}, {}, {}};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver, {}};
    vk.GetPhysicalDeviceProperties2(handle, &properties);
    VkPhysicalDeviceMemoryProperties memory{};
    vk.GetPhysicalDeviceMemoryProperties(handle, &memory);
    DeviceInfo info;
    info.handle = handle;
    info.name = properties.properties.deviceName;
    info.driver = std::string(driver.driverName) + " " + driver.driverInfo;
    info.kind = kind_of(properties.properties.deviceType);
    info.api_version = properties.properties.apiVersion;
    info.unsupported = missing_feature(vk, handle, info.api_version, needs);
    for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i) {
      if (memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) {
        info.memory_bytes = std::max(info.memory_bytes, memory.memoryHeaps[i].size);
      }
    }
    devices.push_back(std::move(info));
  }
  return devices;
}

std::vector<DeviceInfo> list_system_devices() {
  const Instance instance(false);
  return list_devices(instance.vk(), instance.handle());
}

const DeviceInfo& choose_device(const std::vector<DeviceInfo>& devices, const std::string& wanted) {
  // The names of all devices, for messages.
  std::string names;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    names += (i ? ", " : "") + std::to_string(i) + " " + devices[i].name;
    if (!devices[i].unsupported.empty()) names += " (" + devices[i].unsupported + ")";
  }
  if (devices.empty()) {
    throw Error(ErrorCode::no_device,
                "no Vulkan device; install a driver (mesa-vulkan-drivers renders on any CPU)");
  }

  // Select by speed, index or name.
  const DeviceInfo* chosen = nullptr;
  if (wanted.empty()) {
    chosen = &*std::max_element(devices.begin(), devices.end(),
                                [](const auto& a, const auto& b) { return speed_rank(a) < speed_rank(b); });
  } else if (std::all_of(wanted.begin(), wanted.end(), [](unsigned char c) { return std::isdigit(c); })) {
    const std::size_t index = wanted.size() > 6 ? devices.size() : std::stoul(wanted);
    if (index < devices.size()) chosen = &devices[index];
  } else {
    for (const DeviceInfo& device : devices) {
      if (!chosen && lower(device.name).find(lower(wanted)) != std::string::npos) chosen = &device;
    }
  }
  if (!chosen)
    throw Error(ErrorCode::no_device, "no Vulkan device fits \"" + wanted + "\"; available: " + names);
  if (!chosen->unsupported.empty()) {
    throw Error(ErrorCode::no_device, "the Vulkan device cannot be used; available: " + names);
  }
  return *chosen;
}

}  // namespace brume::gpu
