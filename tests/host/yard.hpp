// A host's world out of doors, in which nothing is submitted or waited for by the library, and all of the
// device's memory comes from the host.
#pragma once

#include <cstring>
#include <map>
#include <mutex>

#include "tests/gpu/interposer.hpp"
#include "tests/host/hosted_smoke.hpp"

namespace brume::host {

/// Functions that a library in a host must not call, counted.
struct Waits {
  static inline int calls = 0;
  template <typename... Arguments>
  static VkResult call(Arguments...) {
    ++calls;
    return VK_ERROR_UNKNOWN;
  }
};
// clang-format off
inline const std::vector<gpu::Replacement> kWaiting{
#define X(function) BRUME_INTERPOSED(Waits, function),
    X(QueueSubmit) X(QueueSubmit2) X(QueueWaitIdle) X(DeviceWaitIdle) X(WaitForFences) X(WaitSemaphores)
    X(QueueBindSparse) X(CreateDevice) X(CreateSemaphore) X(CreateFence) X(CreateCommandPool)
#undef X
};
// clang-format on

/// Memory of the device by the host's own functions, in any thread.
struct HostMemory {
  std::mutex mutex;
  gpu::Functions vk;
  VkDevice device = VK_NULL_HANDLE;
  VkPhysicalDeviceMemoryProperties types{};
  std::map<VkDeviceMemory, VkDeviceSize> blocks;
  VkDeviceSize bytes = 0;
  int allocations = 0;
  /// Fills new memory, where it can be mapped, with bytes that are no numbers as half floats.
  PFN_vkUnmapMemory unmap_to_fill = nullptr;

  bool is_mappable(std::uint32_t type) const {
    return (types.memoryTypes[type].propertyFlags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0;
  }
  static VkResult allocate(void* user, const VkMemoryAllocateInfo* info, VkDeviceMemory* memory) {
    auto& own = *static_cast<HostMemory*>(user);
    const VkResult result = own.vk.AllocateMemory(own.device, info, nullptr, memory);
    if (result != VK_SUCCESS) return result;
    const std::scoped_lock lock(own.mutex);
    own.blocks[*memory] = info->allocationSize;
    own.bytes += info->allocationSize;
    ++own.allocations;
    void* bytes = nullptr;
    if (own.unmap_to_fill && own.is_mappable(info->memoryTypeIndex) &&
        own.vk.MapMemory(own.device, *memory, 0, VK_WHOLE_SIZE, 0, &bytes) == VK_SUCCESS) {
      std::memset(bytes, 0xff, info->allocationSize);
      own.unmap_to_fill(own.device, *memory);
    }
    return result;
  }
  static void free(void* user, VkDeviceMemory memory, VkDeviceSize size) {
    auto& own = *static_cast<HostMemory*>(user);
    const std::scoped_lock lock(own.mutex);
    EXPECT_EQ(own.blocks.at(memory), size);
    own.blocks.erase(memory);
    own.bytes -= size;
    own.vk.FreeMemory(own.device, memory, nullptr);
  }
};

/// A yard of a floor and a wall with a door, and as many smokes as a test throws.
class YardTest : public testing::Test {
 protected:
  static constexpr brume_light kLight{BRUME_LIGHT_POINT, {4, 3, 3}, {0, -1, 0}, {0.2f, 0.18f, 0.12f}, 0, 1};
  static constexpr glm::uvec2 kSizes[] = {{64, 36}, {33, 17}, {80, 45}, {1, 7}};

  /// `first`: the size of frames until resize().
  explicit YardTest(gpu::HostKind kind = gpu::kUsualHost, glm::uvec2 first = kSizes[0])
      : first_(first), host_(3, kind), gpu_(host_.device()), recording_(gpu_) {
    memory_.vk = gpu_.vk();
    memory_.device = host_.device().device;
    gpu_.vk().GetPhysicalDeviceMemoryProperties(host_.device().physical_device, &memory_.types);
  }
  ~YardTest() override {
    host_.wait();
    destroy_world();
    EXPECT_OK(brume_renderer_destroy(renderer_));
    EXPECT_OK(brume_device_destroy(device_));
    EXPECT_EQ(memory_.bytes, 0u) << memory_.blocks.size() << " blocks";
    EXPECT_EQ(Waits::calls, 0);
    for (const std::string& message : host_.take_messages()) ADD_FAILURE() << message;
  }

  void make(brume_voxel size, float voxel_size, std::uint32_t march_scale = 1) {
    ASSERT_NO_FATAL_FAILURE(make_world(size, voxel_size, {0, 0, 0}));
    brume_device_params on = params_of(host_.device());
    // Pipelines of several tests have no callbacks.
    if (allocation_callbacks_) on.get_instance_proc_addr = gpu::system_loader();
    on.get_instance_proc_addr = gpu::Interposer::over(on.get_instance_proc_addr, replacements_);
    on.pipeline_cache = cache_;
    on.allocation_callbacks = allocation_callbacks_;
    on.memory_user = &memory_;
    on.allocate_memory = HostMemory::allocate;
    on.free_memory = HostMemory::free;
    ASSERT_OK(brume_device_create(context_.get(), &on, &device_));
    ASSERT_OK(create_renderer(march_scale));
    resize(first_);
  }
  /// The yard with its low corner anywhere, and a field of it.
  void make_world(brume_voxel size, float voxel_size, brume_point origin) {
    destroy_world();
    std::vector<std::uint8_t> solid((static_cast<std::size_t>(size.x) * size.y * size.z + 7) / 8);
    const auto set = [&](int x, int y, int z) {
      const std::size_t i = static_cast<std::size_t>(x) +
                            static_cast<std::size_t>(size.x) *
                                (static_cast<std::size_t>(y) + static_cast<std::size_t>(size.y) * z);
      solid[i / 8] = static_cast<std::uint8_t>(solid[i / 8] | 1 << i % 8);
    };
    for (int z = 0; z < size.z; ++z)
      for (int x = 0; x < size.x; ++x) set(x, 0, z);
    for (int z = 0; z < size.z; ++z)
      for (int y = 1; y < 12; ++y)
        if (z < 10 || z > 16) set(size.x / 2, y, z);
    brume_voxels_params params = brume_voxels_defaults();
    params.layout = {size, voxel_size, origin};
    params.bits = solid.data();
    params.byte_count = solid.size();
    ASSERT_OK(brume_level_create_from_voxels(context_.get(), &params, &level_));
    ASSERT_OK(brume_world_create(level_, nullptr, &world_));
    brume_field_params field = brume_field_defaults();
    ASSERT_OK(brume_field_create(level_, &field, &field_));
  }
  void destroy_world() {
    if (field_) brume_field_destroy(field_);
    if (state_) brume_state_destroy(state_);
    if (world_) brume_world_destroy(world_);
    if (level_) brume_level_destroy(level_);
    field_ = nullptr;
    state_ = nullptr;
    world_ = nullptr;
    level_ = nullptr;
  }
  brume_result create_renderer(std::uint32_t march_scale) {
    brume_renderer_params params = brume_renderer_defaults();
    params.width = first_.x;
    params.height = first_.y;
    params.lights = &kLight;
    params.light_count = 1;
    params.temporal = is_temporal_ ? 1 : 0;
    params.timings = is_timed_ ? 1 : 0;
    params.prepare_all = prepares_all_ ? 1 : 0;
    params.march_scale = march_scale;
    params.motion = has_motion_ ? 1 : 0;
    return brume_renderer_create(device_, &params, &renderer_);
  }
  void resize(glm::uvec2 size) {
    host_.wait();
    depth_ = gpu::Image(gpu_, {.format = VK_FORMAT_R32_SFLOAT,
                               .size = {size, 1},
                               .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                        VK_IMAGE_USAGE_TRANSFER_DST_BIT});
    ASSERT_OK(brume_renderer_resize(renderer_, size.x, size.y));
  }
  /// A yard of 10 x 4 x 7 m, mostly in smoke.
  void make_smoky(std::uint32_t march_scale = 1) {
    make({40, 16, 28}, 0.25f, march_scale);
    smoke(1, {6, 1, 3.5f}, 3000, 2000);
    advance(160);
  }
  /// The same, 10 ticks after a shot.
  void make_shot() {
    make({40, 16, 28}, 0.25f);
    smoke(1, {6, 1, 3.5f}, 3000, 2000);
    brume_event shot = brume_event_defaults(BRUME_EVENT_SHOT, 150);
    shot.u.shot.origin = position_of(sim::position_from_metres({1, 1.5, 3}));
    shot.u.shot.toward = position_of(sim::position_from_metres({9, 1.2, 3.6}));
    append(shot);
    advance(160);
  }
  /// The host's depth, one for each pixel, which frames may then sample.
  void upload_depths(const std::vector<float>& depths) {
    const gpu::Recorder::Region all{std::as_bytes(std::span(depths)), {}, depth_.info().size};
    const gpu::Sampler nearest(gpu_, {});
    host_.frame([&](VkCommandBuffer commands, std::uint64_t number, std::uint64_t completed) {
      recording_.begin(commands, number, completed);
      recording_.recorder().upload(depth_, {&all, 1});
      recording_.recorder().prepare_for_draws({gpu::sampled(depth_, nearest)});  // into its layout
      recording_.end();
      host_.wait_for_compute(commands);
    });
  }
  void append(const brume_event& event) { ASSERT_OK(brume_world_append(world_, &event, 1)); }
  void smoke(std::uint32_t tick, glm::vec3 at, std::uint32_t voxels, std::uint32_t hold) {
    brume_event event = brume_event_defaults(BRUME_EVENT_SMOKE, tick);
    event.u.smoke.from = event.u.smoke.at = position_of(sim::position_from_metres(glm::dvec3(at)));
    event.u.smoke.voxels = voxels;
    event.u.smoke.hold_ticks = hold;
    append(event);
  }
  void advance(std::uint32_t tick) {
    ASSERT_OK(brume_world_advance_to(world_, tick));
    if (state_) brume_state_destroy(state_);
    state_ = nullptr;
    ASSERT_OK(brume_world_state(world_, &state_));
    ASSERT_OK(brume_field_update(field_, state_));
  }
  /// `record` calls brume_renderer_record, with what it adds to the frame.
  void draw(glm::vec3 eye, glm::vec3 forward, double seconds,
            const std::function<void(brume_frame_params&)>& record) {
    host_.frame([&](VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed) {
      recording_.begin(commands, frame, completed);
      recording_.recorder().clear(depth_, {});
      recording_.end();
      host_.wait_for_compute(commands);
      brume_frame_params params = brume_frame_defaults();
      params.commands = commands;
      params.frame_number = frame;
      params.completed_frame = completed;
      params.camera.position = point_of(eye);
      params.camera.forward = point_of(forward);
      params.depth.view = depth_.view();
      params.depth.layout = VK_IMAGE_LAYOUT_GENERAL;
      params.depth.reversed = 1;
      params.seconds = seconds;
      params.jitter_index = static_cast<std::uint32_t>(frame);
      params.continues_previous = frame > 1;
      record(params);
    });
  }
  void draw(glm::vec3 eye, glm::vec3 forward, double seconds) {
    draw(eye, forward, seconds, [&](const brume_frame_params& params) {
      ASSERT_OK(brume_renderer_record(renderer_, field_, &params));
    });
  }
  void limit(std::uint64_t bytes) { EXPECT_OK(brume_device_set_memory_limit(device_, bytes)); }
  std::uint64_t device_bytes() const {
    std::uint64_t bytes = 0;
    EXPECT_OK(brume_device_memory(device_, &bytes));
    return bytes;
  }

  glm::uvec2 first_;
  bool is_temporal_ = true, is_timed_ = false, prepares_all_ = false, has_motion_ = false;
  VkPipelineCache cache_ = VK_NULL_HANDLE;
  const VkAllocationCallbacks* allocation_callbacks_ = nullptr;
  std::vector<gpu::Replacement> replacements_ = kWaiting;
  gpu::HostApplication host_;
  gpu::Context gpu_;
  gpu::HostRecording recording_;
  gpu::Image depth_;
  HostMemory memory_;
  api::Context context_;
  brume_level* level_ = nullptr;
  brume_world* world_ = nullptr;
  brume_state* state_ = nullptr;
  brume_field* field_ = nullptr;
  brume_device* device_ = nullptr;
  brume_renderer* renderer_ = nullptr;
};

}  // namespace brume::host
