// Shader modules and compute pipelines of a host's device that are made once, however often the library is
// given the device: the driver compiles the pipelines of one renderer for longer than it draws the frames of
// a test.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <mutex>
#include <string>
#include <string_view>

#include "gpu/functions.hpp"

namespace brume::gpu {

/// X(function of Vulkan, what stands in its place)
#define BRUME_SHARED_FUNCTIONS                    \
  X(CreateShaderModule, create_module)            \
  X(DestroyShaderModule, destroy_module)          \
  X(CreateDescriptorSetLayout, create_set_layout) \
  X(CreatePipelineLayout, create_layout)          \
  X(CreateComputePipelines, create_pipelines)     \
  X(DestroyPipeline, destroy_pipeline)            \
  X(CmdBindPipeline, bind)

/// One set for each `Owner`, which has one device: Vulkan's functions take no user data to tell devices
/// apart.
///
/// The layers check each pipeline when it is first made. That one is destroyed as often as it is created, is
/// not bound after that and not destroyed before the device has completed its frames is checked here.
template <typename Owner>
class SharedPipelines {
 public:
  /// Starts sharing on a device, which must live until destroy_all().
  static void begin(const Functions& functions, VkDevice device) {
    vk_ = functions;
    device_ = device;
  }
  static void destroy_all() {
    for (const auto& [handle, use] : uses_) {
      EXPECT_EQ(use.users, 0) << "pipelines that nothing destroyed";
      vk_.DestroyPipeline(device_, handle, nullptr);
    }
    for (const auto& [code, handle] : modules_) vk_.DestroyShaderModule(device_, handle, nullptr);
    modules_.clear();
    sets_.clear();
    layouts_.clear();
    pipelines_.clear();
    uses_.clear();
  }
  /// The frame of following commands, and the last one that the device has completed; both rise.
  static inline std::uint64_t frame = 0, completed = 0;

  /// In the place of the loader's function.
  static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instance_proc_addr(VkInstance instance, const char* name) {
    if (std::string_view(name) == "vkGetDeviceProcAddr")
      return reinterpret_cast<PFN_vkVoidFunction>(&device_proc_addr);
    return system_loader()(instance, name);
  }

 private:
  struct Use {
    int users = 0;
    std::uint64_t last_frame = 0;
  };

  static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_proc_addr(VkDevice device, const char* name) {
    if (device == device_) {
#define X(function, own) \
  if (std::string_view(name) == "vk" #function) return reinterpret_cast<PFN_vkVoidFunction>(&own);
      BRUME_SHARED_FUNCTIONS
#undef X
    }
    return vk_.GetDeviceProcAddr(device, name);
  }

  /// Appends the bytes of values without padding.
  template <typename T>
  static void append(std::string& key, const T* values, std::size_t count) {
    key.append(reinterpret_cast<const char*>(&count), sizeof count);
    if (count > 0) key.append(reinterpret_cast<const char*>(values), sizeof(T) * count);
  }

  static VKAPI_ATTR VkResult VKAPI_CALL create_module(VkDevice device, const VkShaderModuleCreateInfo* info,
                                                      const VkAllocationCallbacks*, VkShaderModule* module) {
    const std::lock_guard lock(mutex_);
    const std::string code(reinterpret_cast<const char*>(info->pCode), info->codeSize);
    if (const auto known = modules_.find(code); known != modules_.end()) {
      *module = known->second;
      return VK_SUCCESS;
    }
    const VkResult result = vk_.CreateShaderModule(device, info, nullptr, module);
    if (result == VK_SUCCESS) modules_[code] = *module;
    return result;
  }
  static VKAPI_ATTR void VKAPI_CALL destroy_module(VkDevice, VkShaderModule, const VkAllocationCallbacks*) {}

  static VKAPI_ATTR VkResult VKAPI_CALL create_set_layout(VkDevice device,
                                                          const VkDescriptorSetLayoutCreateInfo* info,
                                                          const VkAllocationCallbacks*,
                                                          VkDescriptorSetLayout* layout) {
    const VkResult result = vk_.CreateDescriptorSetLayout(device, info, nullptr, layout);
    if (result != VK_SUCCESS) return result;
    std::string key;
    for (std::uint32_t i = 0; i < info->bindingCount; ++i) {
      const VkDescriptorSetLayoutBinding& binding = info->pBindings[i];
      EXPECT_EQ(binding.pImmutableSamplers, nullptr) << "would belong to the key";
      const std::uint32_t words[] = {binding.binding, static_cast<std::uint32_t>(binding.descriptorType),
                                     binding.descriptorCount, binding.stageFlags};
      append(key, words, std::size(words));
    }
    const std::lock_guard lock(mutex_);
    sets_[*layout] = std::move(key);
    return result;
  }
  static VKAPI_ATTR VkResult VKAPI_CALL create_layout(VkDevice device, const VkPipelineLayoutCreateInfo* info,
                                                      const VkAllocationCallbacks*,
                                                      VkPipelineLayout* layout) {
    const VkResult result = vk_.CreatePipelineLayout(device, info, nullptr, layout);
    if (result != VK_SUCCESS) return result;
    const std::lock_guard lock(mutex_);
    std::string key;
    for (std::uint32_t i = 0; i < info->setLayoutCount; ++i) {
      const std::string& set = sets_.at(info->pSetLayouts[i]);
      append(key, set.data(), set.size());
    }
    append(key, info->pPushConstantRanges, info->pushConstantRangeCount);
    layouts_[*layout] = std::move(key);
    return result;
  }

  static std::string key_of(const VkComputePipelineCreateInfo& info) {
    EXPECT_TRUE(!info.pNext && !info.stage.pNext) << "would belong to the key";
    const VkSpecializationInfo none{},
        &constants = info.stage.pSpecializationInfo ? *info.stage.pSpecializationInfo : none;
    std::string key = layouts_.at(info.layout);
    append(key, &info.stage.module, 1);
    append(key, &info.flags, 1);
    append(key, info.stage.pName, std::string_view(info.stage.pName).size());
    append(key, constants.pMapEntries, constants.mapEntryCount);
    append(key, static_cast<const char*>(constants.pData), constants.dataSize);
    return key;
  }
  static VKAPI_ATTR VkResult VKAPI_CALL create_pipelines(VkDevice device, VkPipelineCache cache,
                                                         std::uint32_t count,
                                                         const VkComputePipelineCreateInfo* infos,
                                                         const VkAllocationCallbacks*,
                                                         VkPipeline* pipelines) {
    const std::lock_guard lock(mutex_);
    std::fill_n(pipelines, count, VK_NULL_HANDLE);
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::string key = key_of(infos[i]);
      auto known = pipelines_.find(key);
      if (known == pipelines_.end()) {
        VkPipeline made = VK_NULL_HANDLE;
        const VkResult result = vk_.CreateComputePipelines(device, cache, 1, &infos[i], nullptr, &made);
        if (result != VK_SUCCESS) return result;
        known = pipelines_.emplace(key, made).first;
      }
      ++uses_[known->second].users;
      pipelines[i] = known->second;
    }
    return VK_SUCCESS;
  }
  static VKAPI_ATTR void VKAPI_CALL destroy_pipeline(VkDevice device, VkPipeline pipeline,
                                                     const VkAllocationCallbacks*) {
    const std::lock_guard lock(mutex_);
    const auto use = uses_.find(pipeline);
    if (use == uses_.end()) return vk_.DestroyPipeline(device, pipeline, nullptr);  // graphics
    EXPECT_GE(--use->second.users, 0) << "a pipeline is destroyed once more than it was created";
    const std::uint64_t in_use = use->second.users == 0 ? use->second.last_frame : 0;
    EXPECT_LE(in_use, completed) << "a pipeline is destroyed that is in flight";
  }
  static VKAPI_ATTR void VKAPI_CALL bind(VkCommandBuffer commands, VkPipelineBindPoint point,
                                         VkPipeline pipeline) {
    {
      const std::lock_guard lock(mutex_);
      if (const auto use = uses_.find(pipeline); use != uses_.end()) {
        EXPECT_GT(use->second.users, 0) << "a pipeline is bound that was destroyed";
        use->second.last_frame = frame;
      }
    }
    vk_.CmdBindPipeline(commands, point, pipeline);
  }

  static inline std::mutex mutex_;
  static inline Functions vk_;
  static inline VkDevice device_ = VK_NULL_HANDLE;
  // Of modules by their code; of layouts, what they define; of pipelines, all that they are made of.
  static inline std::map<std::string, VkShaderModule> modules_;
  static inline std::map<VkDescriptorSetLayout, std::string> sets_;
  static inline std::map<VkPipelineLayout, std::string> layouts_;
  static inline std::map<std::string, VkPipeline> pipelines_;
  static inline std::map<VkPipeline, Use> uses_;
};

#undef BRUME_SHARED_FUNCTIONS

}  // namespace brume::gpu
