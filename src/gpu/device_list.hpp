// Which Vulkan devices there are, and which one a program gets.
#pragma once

#include <string>
#include <vector>

#include "gpu/functions.hpp"

namespace brume::gpu {

struct DeviceInfo {
  std::string name;    ///< As the driver names it.
  std::string driver;  ///< Driver name and version.
  std::string kind;    ///< "discrete", "integrated", "virtual", "cpu" or "other".
  std::uint32_t api_version = 0;
  std::uint64_t memory_bytes = 0;  ///< The largest device-local heap.
  std::string unsupported;         ///< Why it cannot be used; empty when it can.
  VkPhysicalDevice handle = VK_NULL_HANDLE;
};

/// The devices of an instance, in the driver's order.
std::vector<DeviceInfo> list_devices(const Functions& vk, VkInstance instance);

/// The devices of the system. Throws no_device when there is no loader or no driver.
std::vector<DeviceInfo> list_system_devices();

/// The device for `wanted`: empty = the fastest kind that can be used; a number = that place in the list;
/// otherwise a part of its name, whatever the case. Throws no_device when none fits, naming what there is.
const DeviceInfo& choose_device(const std::vector<DeviceInfo>& devices, const std::string& wanted);

}  // namespace brume::gpu
