// Every call that may fail for want of memory fails once: an error with a sentence, no command at all, and a
// next frame that is right.
#include <array>

#include "gpu/read_back.hpp"
#include "grids/files/grid_files.hpp"
#include "grids/generate.hpp"
#include "scenario/scenario.hpp"
#include "tests/gpu/interposer.hpp"
#include "tests/host/hosted_smoke.hpp"
#include "tests/thorough.hpp"
#include "tests/work_folder.hpp"

namespace brume::host {
namespace {

const bool kEvery = is_thorough("faults");
constexpr std::uint32_t kParts = 3;

/// Which calls there are does not depend on the number of pixels.
constexpr glm::uvec2 kFaultSize{16, 9};

/// Calls of a device until one fails.
struct Faults {
  static inline std::uint32_t calls = 0, fails_at = 0;  // 0: none
  template <typename Function, typename... Arguments>
  static VkResult call(Function real, Arguments... arguments) {
    return ++calls == fails_at ? VK_ERROR_OUT_OF_DEVICE_MEMORY : real(arguments...);
  }
};
/// Commands that were recorded.
struct Commands {
  static inline int count = 0;
  template <typename Function, typename... Arguments>
  static void call(Function real, Arguments... arguments) {
    ++count;
    real(arguments...);
  }
};

// clang-format off
const std::vector<gpu::Replacement> kFaulty{
#define X(function) BRUME_INTERPOSED(Faults, function),
    X(AllocateMemory) X(MapMemory) X(CreateBuffer) X(BindBufferMemory) X(CreateImage) X(BindImageMemory)
    X(CreateImageView) X(CreateSampler) X(CreateShaderModule) X(CreateDescriptorSetLayout) X(CreatePipelineLayout)
    X(CreateComputePipelines) X(CreateGraphicsPipelines) X(CreateDescriptorPool) X(ResetDescriptorPool)
    X(AllocateDescriptorSets) X(CreateQueryPool) X(CreateRenderPass) X(CreateFramebuffer)
#undef X
#define X(function) BRUME_INTERPOSED(Commands, function),
    X(CmdDispatch) X(CmdPipelineBarrier2) X(CmdUpdateBuffer) X(CmdResetQueryPool) X(CmdWriteTimestamp)
#undef X
};
// clang-format on

class FaultTest : public testing::Test {
 protected:
  FaultTest()
      : scenario_(render::two_smokes(0.6f)),
        host_(2),
        gpu_(host_.device()),
        recording_(gpu_),
        depth_(gpu_, depth_info()) {
    HostedSmoke::size = kFaultSize;
    HostedSmoke::is_timed = true;
    scenario_.timeline.doors.clear();
    const float all = 1;
    brume_decal_params params = brume_decal_defaults();
    params.up = &all;
    for (std::uint32_t& along : params.size) along = 1;
    EXPECT_OK(brume_decal_create(context_.get(), &params, &decal_));
  }
  ~FaultTest() override {
    HostedSmoke::size = kSize;
    HostedSmoke::is_timed = false;
    host_.wait();
    EXPECT_OK(brume_decal_destroy(decal_));
    EXPECT_OK(brume_volume_destroy(volume_));
    EXPECT_OK(brume_tank_destroy(tank_));
  }
  /// Frames also have a volume, tanks by both views, a light, bounces and shadows.
  void add_media() {
    const std::string file = (folder_.path() / "cloud.brv").string();
    const grids::Grid cloud =
        grids::generate_cloud({.kind = grids::CloudKind::sphere, .edge = 24, .voxel_size = 0.1, .radius = 1});
    grids::save_grid_file(file, {{cloud}, {}}).value_or_throw();
    brume_volume_params volume = brume_volume_defaults();
    volume.file = file.c_str();
    ASSERT_OK(brume_volume_create(context_.get(), &volume, &volume_));
    constexpr std::array kSphere{8.0f, 8.0f, 8.0f, 6.0f};
    constexpr std::uint32_t kWhite = 0xffffffff;
    brume_tank_params tank = brume_tank_defaults();
    for (std::uint32_t& along : tank.size) along = 16;
    tank.voxel = 0.1f;
    tank.spheres = kSphere.data();
    tank.colors = &kWhite;
    tank.sphere_count = 1;
    ASSERT_OK(brume_tank_create(context_.get(), &tank, &tank_));
  }
  void TearDown() override {
    host_.wait();
    for (const std::string& message : host_.take_messages()) ADD_FAILURE() << message;
  }

  static gpu::ImageInfo depth_info() {
    return {
        .format = VK_FORMAT_R32_SFLOAT,
        .size = {kFaultSize, 1},
        .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT};
  }
  /// The host's device, some of whose functions may fail for the interface.
  gpu::HostDevice faulty_device() const {
    gpu::HostDevice device = host_.device();
    device.get_instance_proc_addr = gpu::Interposer::over(device.get_instance_proc_addr, kFaulty);
    return device;
  }

  /// A frame of nothing but smoke, and of a decal on no surface; with other media it is the second view of
  /// two.
  brume_result draw(HostedSmoke& smoke, double seconds) {
    smoke.advance_to(seconds);
    brume_result result = BRUME_OK;
    picture_ = gpu::readback_buffer(gpu_, VkDeviceSize{8} * kFaultSize.x * kFaultSize.y);
    host_.frame([&](VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed) {
      recording_.begin(commands, frame, completed);
      recording_.recorder().clear(depth_, {});
      recording_.end();
      host_.wait_for_compute(commands);
      brume_frame_params params = frame_of(scenario_, seconds);
      params.commands = commands;
      params.frame_number = frame;
      params.completed_frame = completed;
      params.depth.view = depth_.view();
      params.depth.layout = VK_IMAGE_LAYOUT_GENERAL;
      const brume_shown_decal shown = brume_shown_decal_defaults(decal_);
      params.decals = &shown;
      params.decal_count = 1;
      const brume_frame_params first = params;
      Media media;
      if (tank_) media.show(*this, params);
      params.view = tank_ ? 1 : 0;
      const brume_frame_params* const views[] = {&first, &params};
      Commands::count = 0;
      result = tank_ ? brume_renderer_record_views(smoke.renderer, smoke.field.get(), views, 2)
                     : brume_renderer_record(smoke.renderer, smoke.field.get(), &params);
      EXPECT_EQ(Commands::count > 0, result == BRUME_OK) << "a part of a frame was recorded";
      VkImage image = VK_NULL_HANDLE;
      if (result != BRUME_OK) {
        EXPECT_STRNE(brume_last_error(), "");
        EXPECT_EQ(brume_renderer_smoke(smoke.renderer, &image, nullptr), BRUME_ERROR_ORDER);
        return;
      }
      EXPECT_OK(brume_renderer_smoke(smoke.renderer, &image, nullptr));
      host_.copy(commands, image, {kFaultSize.x, kFaultSize.y}, picture_.handle());
    });
    host_.wait();
    return result;
  }
  std::vector<std::byte> picture() const { return {picture_.mapped(), picture_.mapped() + picture_.size()}; }

  struct Media {
    void show(const FaultTest& test, brume_frame_params& params) {
      volume = brume_shown_volume_defaults(test.volume_);
      volume.position = {-3, 1, 1};
      tanks.fill(brume_shown_tank_defaults(test.tank_));
      tanks[0].position = {2, 1, 3};
      tanks[1].position = {-2, 1, 3};
      tanks[1].view = BRUME_TANK_VOXELS;
      light = {BRUME_LIGHT_POINT, {0, 2, 2}, {0, -1, 0}, {5, 5, 5}, 0, 0};
      params.volumes = &volume;
      params.volume_count = 1;
      params.tanks = tanks.data();
      params.tank_count = tanks.size();
      params.lights = &light;
      params.light_count = 1;
      params.bounces = 1;
      params.shadow_light_count = 1;
    }
    brume_shown_volume volume{};
    std::array<brume_shown_tank, 2> tanks{};
    brume_light light{};
  };
  void fail_each_call();

  scenario::Scenario scenario_;
  cli::WorkFolder folder_;
  gpu::HostApplication host_;
  gpu::Context gpu_;
  gpu::HostRecording recording_;
  gpu::Image depth_;
  gpu::Buffer picture_;
  api::Context context_;
  brume_decal* decal_ = nullptr;
  brume_volume* volume_ = nullptr;
  brume_tank* tank_ = nullptr;
};

void FaultTest::fail_each_call() {
  constexpr double kFirst = 2, kSecond = 5.25;  // smoke; two smokes, and a shot
  Faults::calls = Faults::fails_at = 0;
  std::uint32_t calls_of_first = 0;
  std::vector<std::byte> first, second, second_alone;
  {
    HostedSmoke smoke(faulty_device(), scenario_, 1);
    ASSERT_OK(draw(smoke, kFirst));
    first = picture();
    calls_of_first = Faults::calls;
    ASSERT_OK(draw(smoke, kSecond));
    second = picture();
  }
  const std::uint32_t calls = Faults::calls;
  {
    HostedSmoke smoke(faulty_device(), scenario_, 1);
    ASSERT_OK(draw(smoke, kSecond));
    second_alone = picture();
  }
  ASSERT_GT(calls, 100u);
  EXPECT_NE(first, second);

  // Not every one of them in the fast suite: the first of each of some equal parts.
  const std::uint32_t step = kEvery ? 1 : (calls + kParts - 1) / kParts;
  std::uint32_t failures = 0;
  for (std::uint32_t fails_at = 1; fails_at <= calls; fails_at += step) {
    SCOPED_TRACE("call " + std::to_string(fails_at) + " of " + std::to_string(calls));
    if (kEvery) {
      std::printf("call %u of %u\n", fails_at, calls);
      std::fflush(stdout);
    }
    Faults::calls = 0;
    Faults::fails_at = fails_at;
    HostedSmoke smoke(faulty_device(), scenario_, 1, HostedSmoke::Failure::allowed);
    // Until it works, as a host would: the device, the renderer, frames.
    for (const double seconds : {kFirst, kSecond})
      for (int tries = 0;; ++tries) {
        ASSERT_LT(tries, 2);
        const brume_result result = smoke.made(scenario_, 1) ? draw(smoke, seconds) : BRUME_ERROR_LIMIT;
        if (result == BRUME_OK) break;
        ++failures;
        EXPECT_TRUE(result == BRUME_ERROR_LIMIT || result == BRUME_ERROR_DEVICE) << brume_last_error();
      }
    // A failed frame costs at most its own calls again, not the renderer's. A failed frame of several views
    // makes the renderer again.
    if (fails_at > calls_of_first) {
      EXPECT_LE(Faults::calls, tank_ ? 2 * calls : calls + (calls - calls_of_first));
    }
    // A plan that was given up leaves nothing up to date. Bricks that are placed again lie elsewhere in
    // their image, where coordinates round otherwise.
    EXPECT_TRUE(picture() == second || picture() == second_alone);
  }
  Faults::fails_at = 0;
  // Where memory is refused, a coarser frame may do without it: not every fault is a failure of the frame.
  EXPECT_GT(failures, kParts / 2);
}

TEST_F(FaultTest, EveryCallMayFailOnce) {
  fail_each_call();
}

TEST_F(FaultTest, EveryCallMayFailOnceInFramesOfAllMedia) {
  add_media();
  fail_each_call();
}

TEST_F(FaultTest, NoImageIsLeftWhereAResizeFails) {
  HostedSmoke smoke(faulty_device(), scenario_, 1);
  std::uint32_t failures = 0;
  for (std::uint32_t fails_at = 1;; fails_at += 5) {
    Faults::fails_at = 0;
    ASSERT_OK(draw(smoke, 2));
    Faults::calls = 0;
    Faults::fails_at = fails_at;
    if (brume_renderer_resize(smoke.renderer, kFaultSize.x, kFaultSize.y) == BRUME_OK) break;
    ++failures;
    VkImage image = VK_NULL_HANDLE;
    std::uint32_t level = 0;
    EXPECT_EQ(brume_renderer_smoke(smoke.renderer, &image, nullptr), BRUME_ERROR_ORDER);
    EXPECT_EQ(brume_renderer_occlusion(smoke.renderer, &image, nullptr), BRUME_ERROR_ORDER);
    EXPECT_EQ(brume_renderer_coarseness(smoke.renderer, &level, nullptr), BRUME_ERROR_ORDER);
  }
  Faults::fails_at = 0;
  EXPECT_GT(failures, 1u);
}

}  // namespace
}  // namespace brume::host
