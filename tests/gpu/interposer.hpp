// Functions of Vulkan with others in their place, for hosts of tests.
#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "gpu/functions.hpp"

namespace brume::gpu {

/// Calls `Policy::call(real, arguments...)` in the place of a function. A policy tells functions apart by
/// their types: of those that it calls, no two have the same.
template <typename Policy, typename Function>
struct Interposed;
template <typename Policy, typename Result, typename... Arguments>
struct Interposed<Policy, Result(VKAPI_PTR*)(Arguments...)> {
  static inline Result(VKAPI_PTR* real)(Arguments...) = nullptr;
  static VKAPI_ATTR Result VKAPI_CALL call(Arguments... arguments) {
    return Policy::call(real, arguments...);
  }
  static PFN_vkVoidFunction replace(PFN_vkVoidFunction function) {
    real = reinterpret_cast<decltype(real)>(function);
    return reinterpret_cast<PFN_vkVoidFunction>(&call);
  }
};

struct Replacement {
  std::string_view name;
  PFN_vkVoidFunction (*replace)(PFN_vkVoidFunction real);
};
#define BRUME_INTERPOSED(policy, function)                                      \
  ::brume::gpu::Replacement {                                                   \
    "vk" #function, ::brume::gpu::Interposed<policy, PFN_vk##function>::replace \
  }

/// One for all hosts of a program: Vulkan's functions take no user data to tell them apart.
class Interposer {
 public:
  /// In the place of a loader's function; for devices that are made from now on.
  static PFN_vkGetInstanceProcAddr over(PFN_vkGetInstanceProcAddr real,
                                        std::vector<Replacement> replacements) {
    instance_proc_addr_ = real;
    replacements_ = std::move(replacements);
    return of_instance;
  }

 private:
  static PFN_vkVoidFunction replaced(std::string_view name, PFN_vkVoidFunction real) {
    for (const Replacement& replacement : replacements_)
      if (name == replacement.name) return replacement.replace(real);
    return real;
  }
  static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL of_device(VkDevice device, const char* name) {
    return replaced(name, device_proc_addr_(device, name));
  }
  static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL of_instance(VkInstance instance, const char* name) {
    const PFN_vkVoidFunction real = instance_proc_addr_(instance, name);
    if (std::string_view(name) != "vkGetDeviceProcAddr") return replaced(name, real);
    device_proc_addr_ = reinterpret_cast<PFN_vkGetDeviceProcAddr>(real);
    return reinterpret_cast<PFN_vkVoidFunction>(&of_device);
  }

  static inline PFN_vkGetInstanceProcAddr instance_proc_addr_ = nullptr;
  static inline PFN_vkGetDeviceProcAddr device_proc_addr_ = nullptr;
  static inline std::vector<Replacement> replacements_;
};

}  // namespace brume::gpu
