// Devices that lack a feature are refused when they are handed over.
#include <cstring>

#include "tests/host/hosted_smoke.hpp"

namespace brume::host {
namespace {

PFN_vkGetInstanceProcAddr g_proc_addr_of_all = nullptr;
PFN_vkGetPhysicalDeviceFeatures2 g_all_features = nullptr;
VkBool32 VkPhysicalDeviceVulkan12Features::*g_missing_of_12 = nullptr;
VkBool32 VkPhysicalDeviceVulkan13Features::*g_missing_of_13 = nullptr;

void VKAPI_PTR features_without(VkPhysicalDevice device, VkPhysicalDeviceFeatures2* features) {
  g_all_features(device, features);
  for (auto* each = static_cast<VkBaseOutStructure*>(features->pNext); each; each = each->pNext) {
    if (g_missing_of_12 && each->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES)
      reinterpret_cast<VkPhysicalDeviceVulkan12Features*>(each)->*g_missing_of_12 = VK_FALSE;
    if (g_missing_of_13 && each->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES)
      reinterpret_cast<VkPhysicalDeviceVulkan13Features*>(each)->*g_missing_of_13 = VK_FALSE;
  }
}

PFN_vkVoidFunction VKAPI_PTR proc_addr_without(VkInstance instance, const char* name) {
  const PFN_vkVoidFunction real = g_proc_addr_of_all(instance, name);
  if (std::strcmp(name, "vkGetPhysicalDeviceFeatures2") != 0) return real;
  g_all_features = reinterpret_cast<PFN_vkGetPhysicalDeviceFeatures2>(real);
  return reinterpret_cast<PFN_vkVoidFunction>(features_without);
}

TEST(DeviceTest, IsRefusedWithoutAFeature) {
  gpu::HostApplication application(1);
  const api::Context context;
  brume_device_params params = params_of(application.device());
  g_proc_addr_of_all = std::exchange(params.get_instance_proc_addr, proc_addr_without);
  const auto expect_named = [&](const char* feature) {
    brume_device* device = nullptr;
    expect_refused(brume_device_create(context.get(), &params, &device), BRUME_ERROR_DEVICE, feature);
    EXPECT_EQ(device, nullptr);
  };
  g_missing_of_12 = &VkPhysicalDeviceVulkan12Features::scalarBlockLayout;
  expect_named("lacks scalarBlockLayout");
  g_missing_of_12 = &VkPhysicalDeviceVulkan12Features::timelineSemaphore;
  expect_named("lacks timelineSemaphore");
  g_missing_of_12 = nullptr;
  g_missing_of_13 = &VkPhysicalDeviceVulkan13Features::synchronization2;
  expect_named("lacks synchronization2");
  g_missing_of_13 = nullptr;
  brume_device* device = nullptr;
  EXPECT_OK(brume_device_create(context.get(), &params, &device));
  EXPECT_OK(brume_device_destroy(device));
}

}  // namespace
}  // namespace brume::host
