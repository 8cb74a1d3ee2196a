// Devices are refused when they are handed over, unless they have what the renderer needs.
#include <regex>

#include "core/file.hpp"
#include "tests/gpu/interposer.hpp"
#include "tests/host/hosted_smoke.hpp"

namespace brume::host {
namespace {

/// Clears a feature in the struct of its version, in a chain.
void clear(const gpu::Feature& feature, VkPhysicalDeviceFeatures2& chain) {
  for (auto* each = reinterpret_cast<VkBaseOutStructure*>(&chain); each; each = each->pNext)
    if (each->sType == feature.of_version.type)
      *reinterpret_cast<VkBool32*>(reinterpret_cast<std::byte*>(each) + feature.of_version.offset) = 0;
}

/// What a physical device reports in the place of the truth.
struct Reported {
  static inline const gpu::Feature* missing = nullptr;
  static inline std::uint32_t api_version = 0;
  static inline VkSubgroupFeatureFlags lost_operations = 0;
  static inline VkShaderStageFlags lost_stages = 0;
  static inline VkQueueFlags lost_queues = 0;

  static void reset() {
    missing = nullptr;
    api_version = 0;
    lost_operations = 0;
    lost_stages = 0;
    lost_queues = 0;
  }
  static void call(PFN_vkGetPhysicalDeviceFeatures2 real, VkPhysicalDevice device,
                   VkPhysicalDeviceFeatures2* features) {
    real(device, features);
    if (missing) clear(*missing, *features);
  }
  static void call(PFN_vkGetPhysicalDeviceProperties2 real, VkPhysicalDevice device,
                   VkPhysicalDeviceProperties2* properties) {
    real(device, properties);
    if (api_version > 0) properties->properties.apiVersion = api_version;
    for (auto* each = static_cast<VkBaseOutStructure*>(properties->pNext); each; each = each->pNext) {
      if (each->sType != VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES) continue;
      auto& subgroups = *reinterpret_cast<VkPhysicalDeviceSubgroupProperties*>(each);
      subgroups.supportedOperations &= ~lost_operations;
      subgroups.supportedStages &= ~lost_stages;
    }
  }
  static void call(PFN_vkGetPhysicalDeviceQueueFamilyProperties real, VkPhysicalDevice device,
                   std::uint32_t* count, VkQueueFamilyProperties* families) {
    real(device, count, families);
    for (std::uint32_t i = 0; families && i < *count; ++i) families[i].queueFlags &= ~lost_queues;
  }
};

class DeviceTest : public testing::Test {
 protected:
  DeviceTest() : params_(params_of(application_.device())) {
    Reported::reset();
    params_.get_instance_proc_addr = gpu::Interposer::over(
        params_.get_instance_proc_addr, {BRUME_INTERPOSED(Reported, GetPhysicalDeviceFeatures2),
                                         BRUME_INTERPOSED(Reported, GetPhysicalDeviceProperties2),
                                         BRUME_INTERPOSED(Reported, GetPhysicalDeviceQueueFamilyProperties)});
  }
  void TearDown() override {
    for (const std::string& message : application_.take_messages()) ADD_FAILURE() << message;
  }
  void expect_refused_device(brume_result result, const std::string& words) {
    brume_device* device = nullptr;
    expect_refused(brume_device_create(context_.get(), &params_, &device), result, words);
    EXPECT_EQ(device, nullptr);
  }
  void expect_taken() {
    brume_device* device = nullptr;
    EXPECT_OK(brume_device_create(context_.get(), &params_, &device));
    EXPECT_OK(brume_device_destroy(device));
  }

  gpu::HostApplication application_{1};
  const api::Context context_;
  brume_device_params params_;
};

TEST_F(DeviceTest, IsRefusedWithoutAFeature) {
  for (const gpu::Feature& feature : gpu::required_features()) {
    Reported::missing = &feature;
    expect_refused_device(BRUME_ERROR_DEVICE, std::string("lacks ") + feature.name);
  }
  Reported::reset();
  expect_taken();
}

TEST_F(DeviceTest, IsTakenWithoutWhatCanBeReplaced) {
  for (const gpu::Feature& feature : gpu::optional_features()) {
    Reported::missing = &feature;
    expect_taken();
  }
}

TEST_F(DeviceTest, IsRefusedBeforeVulkan12) {
  Reported::api_version = VK_API_VERSION_1_1;
  expect_refused_device(BRUME_ERROR_DEVICE, "only Vulkan versions before 1.2");
  Reported::api_version = VK_API_VERSION_1_2;
  expect_taken();
}

TEST_F(DeviceTest, IsRefusedWithoutSubgroupOperations) {
  for (const VkSubgroupFeatureFlags operation :
       {VK_SUBGROUP_FEATURE_VOTE_BIT, VK_SUBGROUP_FEATURE_ARITHMETIC_BIT, VK_SUBGROUP_FEATURE_BALLOT_BIT}) {
    Reported::lost_operations = operation;
    expect_refused_device(BRUME_ERROR_DEVICE, "lacks subgroup vote, arithmetic or ballot");
  }
  Reported::reset();
  Reported::lost_stages = VK_SHADER_STAGE_COMPUTE_BIT;
  expect_refused_device(BRUME_ERROR_DEVICE, "in compute shaders");
  Reported::reset();
  Reported::lost_operations = VK_SUBGROUP_FEATURE_QUAD_BIT;
  expect_taken();
}

TEST_F(DeviceTest, IsRefusedForAnotherQueueFamily) {
  std::uint32_t families = 0;
  gpu::Context(application_.device())
      .vk()
      .GetPhysicalDeviceQueueFamilyProperties(params_.physical_device, &families, nullptr);
  params_.queue_family = families;
  expect_refused_device(BRUME_ERROR_ARGUMENT, "the physical device has " + std::to_string(families));
  params_.queue_family = UINT32_MAX;
  expect_refused_device(BRUME_ERROR_ARGUMENT, "the queue family 4294967295 does not exist");
  params_.queue_family = 0;
  const std::pair<VkQueueFlags, const char*> cases[] = {
      {VK_QUEUE_GRAPHICS_BIT, "the queue family 0 lacks graphics;"},
      {VK_QUEUE_COMPUTE_BIT, "the queue family 0 lacks compute;"},
      {VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT, "the queue family 0 lacks graphics and compute;"}};
  for (const auto& [lost, sentence] : cases) {
    Reported::lost_queues = lost;
    expect_refused_device(BRUME_ERROR_ARGUMENT, sentence);
  }
  Reported::lost_queues = VK_QUEUE_TRANSFER_BIT;
  expect_taken();
}

TEST_F(DeviceTest, IsRefusedWhereTheHostForgotAFeature) {
  for (const gpu::Feature& feature : gpu::required_features()) {
    gpu::DeviceFeatures all;
    clear(feature, all.features);
    params_.enabled_features = all.chain();
    expect_refused_device(BRUME_ERROR_DEVICE, std::string("the device was created without ") + feature.name);
  }
  params_.enabled_features = brume_vulkan_features();
  expect_taken();
  for (const gpu::Feature& feature : gpu::optional_features()) {
    gpu::DeviceFeatures all;
    clear(feature, all.features);
    params_.enabled_features = all.chain();
    expect_taken();
  }

  VkPhysicalDeviceVulkan12Features other{};
  other.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  params_.enabled_features = &other;
  expect_refused_device(BRUME_ERROR_ARGUMENT, "has no VkPhysicalDeviceFeatures2");
  other.pNext = &other;
  expect_refused_device(BRUME_ERROR_ARGUMENT, "is a circle");
}

/// A host's own chain of features, of any of the structs below.
struct OwnChain {
  VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, nullptr, {}};
  VkPhysicalDeviceVulkan12Features vulkan12{};
  VkPhysicalDeviceVulkan13Features vulkan13{};
  VkPhysicalDeviceTimelineSemaphoreFeatures timeline{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES, nullptr, VK_TRUE};
  VkPhysicalDeviceDynamicRenderingFeatures rendering{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES, nullptr, VK_FALSE};
  VkPhysicalDeviceSynchronization2Features synchronization{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES, nullptr, VK_FALSE};

  OwnChain() {
    features.features.robustBufferAccess = VK_TRUE;
    vulkan12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    vulkan12.timelineSemaphore = VK_TRUE;
    vulkan13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    vulkan13.maintenance4 = VK_TRUE;
  }
  /// Links structs behind `features`.
  template <typename... Structs>
  void link(Structs&... structs) {
    void** end = &features.pNext;
    ((*end = &structs, end = &structs.pNext), ...);
  }
};

class MergeTest : public DeviceTest {
 protected:
  /// The merged chain creates a device, without a word of the layers, which is then taken.
  void expect_merged(void* chain, const OwnChain& own) {
    brume_feature_storage storage;
    ASSERT_OK(brume_vulkan_merge_features(chain, &storage));
    EXPECT_TRUE(own.features.features.robustBufferAccess && own.vulkan12.timelineSemaphore &&
                own.vulkan13.maintenance4 && own.timeline.timelineSemaphore);
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue{
        VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, nullptr, 0, 0, 1, &priority};
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.pNext = chain;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    gpu::Functions vk = gpu::SharedDevice<gpu::HostKind::validated>::get().instance.vk();
    ASSERT_EQ(vk.CreateDevice(params_.physical_device, &info, nullptr, &params_.device), VK_SUCCESS);
    vk.load_device(params_.device);
    params_.enabled_features = chain;
    expect_taken();
    vk.DestroyDevice(params_.device, nullptr);
    for (const std::string& message : application_.take_messages()) ADD_FAILURE() << message;
  }
};

TEST_F(MergeTest, AddsWhatAChainLacks) {
  OwnChain own;
  expect_merged(&own.features, own);
}

TEST_F(MergeTest, SetsTheStructsOfVersions) {
  OwnChain own;
  own.link(own.vulkan12, own.vulkan13);
  expect_merged(&own.features, own);
  EXPECT_EQ(own.vulkan13.pNext, nullptr) << "nothing was missing";
}

TEST_F(MergeTest, SetsTheStructsOfSingleFeatures) {
  OwnChain own;
  own.link(own.timeline, own.synchronization, own.rendering);
  expect_merged(&own.features, own);
  EXPECT_TRUE(own.rendering.dynamicRendering && own.synchronization.synchronization2);
}

TEST_F(MergeTest, SetsBothKindsOfStructs) {
  OwnChain own;
  own.link(own.synchronization, own.vulkan12);
  expect_merged(&own.features, own);
}

TEST_F(MergeTest, TakesFeatures2InAnyPlaceAndTwice) {
  OwnChain own;
  own.timeline.pNext = &own.features;
  brume_feature_storage storage;
  ASSERT_OK(brume_vulkan_merge_features(&own.timeline, &storage));
  const void* const appended = own.features.pNext;
  EXPECT_NE(appended, nullptr);
  brume_feature_storage second;
  ASSERT_OK(brume_vulkan_merge_features(&own.timeline, &second));
  EXPECT_EQ(own.features.pNext, appended);
  params_.enabled_features = &own.timeline;
  expect_taken();
}

TEST_F(MergeTest, RefusesWhatIsNoChainOfFeatures) {
  OwnChain own;
  brume_feature_storage storage;
  expect_refused(brume_vulkan_merge_features(&own.vulkan13, &storage), BRUME_ERROR_ARGUMENT,
                 "has no VkPhysicalDeviceFeatures2");
  EXPECT_FALSE(own.vulkan13.synchronization2);
  EXPECT_EQ(own.vulkan13.pNext, nullptr);
  expect_refused(brume_vulkan_merge_features(nullptr, &storage), BRUME_ERROR_ARGUMENT, "`chain` is null");
  expect_refused(brume_vulkan_merge_features(&own.features, nullptr), BRUME_ERROR_ARGUMENT,
                 "`storage` is null");
  EXPECT_FALSE(own.features.features.samplerAnisotropy);
}

TEST(DeviceDocs, HaveTheTableOfFeatures) {
  const std::string page = *read_text_file(BRUME_SOURCE_DIR "/docs/reference/c-api.md");
  const std::size_t from = page.find("## Vulkan device features"), to = page.find("\n## ", from);
  const std::string section = page.substr(from, to - from);
  static const std::regex kRow(R"(\n\| `(\w+)` \|)");
  std::vector<std::string> documented, used;
  for (std::sregex_iterator row(section.begin(), section.end(), kRow), end; row != end; ++row)
    documented.push_back((*row)[1]);
  for (const gpu::Feature& feature : gpu::features()) used.emplace_back(feature.name);
  EXPECT_EQ(documented, used);
}

}  // namespace
}  // namespace brume::host
