// Enumeration and selection of Vulkan devices.
#pragma once

#include <string>
#include <vector>

#include "gpu/device_features.hpp"
#include "gpu/functions.hpp"

namespace brume::gpu {

/// From the slowest to the fastest.
enum class DeviceKind { cpu, other, virtual_gpu, integrated, discrete };
/// "discrete", "integrated", "virtual", "cpu" or "other".
const char* name_of(DeviceKind kind);

struct DeviceInfo {
  std::string name;    ///< As reported by the driver.
  std::string driver;  ///< Driver name and version.
  DeviceKind kind = DeviceKind::other;
  std::uint32_t api_version = 0;
  std::uint64_t memory_bytes = 0;  ///< The largest device-local heap.
  std::string unsupported;         ///< Why it cannot be used; empty if it can.
  VkPhysicalDevice handle = VK_NULL_HANDLE;
};

/// What a device must support.
struct DeviceNeeds {
  std::uint32_t api_version = VK_API_VERSION_1_3;
  std::span<const Feature> features = gpu::features();
};
/// What a host's device must support.
inline DeviceNeeds host_needs() {
  return {VK_API_VERSION_1_2, required_features()};
}

/// The devices of an instance, in the driver's order.
std::vector<DeviceInfo> list_devices(const Functions& vk, VkInstance instance, const DeviceNeeds& needs = {});

/// The devices of the system. Throws no_device when there is no loader or no driver.
std::vector<DeviceInfo> list_system_devices();

/// Selects a device by `wanted`: empty = the fastest supported kind; a number = that index in the list;
/// otherwise a part of its name, ignoring case. Throws no_device when none fits, listing all devices.
const DeviceInfo& choose_device(const std::vector<DeviceInfo>& devices, const std::string& wanted);

}  // namespace brume::gpu
