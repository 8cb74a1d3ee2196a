#include "gpu/device_features.hpp"
#include "host/compile.hpp"
#include "host/frame.hpp"
#include "host/objects.hpp"

using namespace brume::api;
using brume::gpu::DeviceFeatures;
using brume::gpu::HostDevice;

namespace brume::host {

bool can_blend(const gpu::Context& context, VkFormat format) {
  if (format <= VK_FORMAT_UNDEFINED || format > VK_FORMAT_ASTC_12x12_SRGB_BLOCK) return false;
  VkFormatProperties properties{};
  context.vk().GetPhysicalDeviceFormatProperties(context.info().handle, format, &properties);
  return (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT) != 0;
}

namespace {

HostDevice host_device(const brume_device_params& params) {
  require(params.get_instance_proc_addr != nullptr, "`get_instance_proc_addr` is null");
  require(params.instance != VK_NULL_HANDLE, "`instance` is null");
  require(params.physical_device != VK_NULL_HANDLE, "`physical_device` is null");
  require(params.device != VK_NULL_HANDLE, "`device` is null");
  require((params.allocate_memory == nullptr) == (params.free_memory == nullptr),
          "`allocate_memory` and `free_memory` must both be given, or neither");
  return {.get_instance_proc_addr = params.get_instance_proc_addr,
          .instance = params.instance,
          .physical_device = params.physical_device,
          .device = params.device,
          .queue_family = params.queue_family,
          .memory = {params.memory_user, params.allocate_memory, params.free_memory},
          .enabled_features = params.enabled_features,
          .pipeline_cache = params.pipeline_cache,
          .allocator = params.allocation_callbacks};
}

static_assert(sizeof(brume_feature_storage) == sizeof(gpu::FeatureStructs) &&
              alignof(brume_feature_storage) >= alignof(gpu::FeatureStructs));

}  // namespace
}  // namespace brume::host

extern "C" {

const void* brume_vulkan_features(void) BRUME_NOEXCEPT {
  static const DeviceFeatures features;
  return features.chain();
}

brume_result brume_vulkan_merge_features(void* chain, brume_feature_storage* storage) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call&) {
    require(chain != nullptr, "`chain` is null");
    unwrap(
        brume::gpu::merge_features(chain, *new (&required(storage, "storage")) brume::gpu::FeatureStructs));
  });
}

brume_result brume_device_create(brume_context* context, const brume_device_params* params,
                                 brume_device** device) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const brume_context& owner = call.handle(context);
    required(device, "device");
    create(device, owner.settings, brume::host::host_device(required_params(params)));
  });
}

brume_result brume_device_compile(brume_device* device, const brume_renderer_params* renderer,
                                  const brume_frame_params* frame) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const std::shared_ptr<brume::host::DeviceData> data = call.handle(device).data;
    brume::host::compile(call, *data, params_or_defaults(renderer), params_or_defaults(frame));
  });
}

brume_result brume_device_destroy(brume_device* device) BRUME_NOEXCEPT {
  if (!device) return BRUME_OK;
  return Call(__func__).run([&](Call& call) {
    brume_device& held = call.handle(device);
    const auto data = held.data;
    const std::scoped_lock lock(data->mutex);  // until a renderer that another thread destroys is gone
    if (data->renderers > 0) fail(BRUME_ERROR_ORDER, "a renderer of the device must be destroyed first");
    delete &held;
  });
}

brume_result brume_device_memory(const brume_device* device, uint64_t* bytes) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const brume_device& held = call.handle(device);
    required(bytes, "bytes") = held.data->context.memory().device_bytes();
  });
}

brume_result brume_device_allocated_memory(const brume_device* device, uint64_t* bytes) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const brume_device& held = call.handle(device);
    required(bytes, "bytes") = held.data->context.memory().allocated_bytes();
  });
}

brume_result brume_device_set_memory_limit(brume_device* device, uint64_t bytes) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) { call.handle(device).data->context.memory().set_limit(bytes); });
}

}  // extern "C"
