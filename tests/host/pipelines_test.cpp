// Pipelines belong to the device: what one renderer has compiled, no other compiles again.
#include <brume/brume_vulkan.hpp>

#include <atomic>
#include <set>
#include <thread>

#include "grids/files/grid_files.hpp"
#include "grids/generate.hpp"
#include "tests/host/yard.hpp"
#include "tests/work_folder.hpp"

namespace brume::host {
namespace {

/// Pipelines that are compiled, and what with.
struct Compiled {
  static inline std::atomic<int> count = 0, destroyed = 0;
  static inline std::atomic<std::uint32_t> most_colours = 0;
  static inline VkPipelineCache cache = VK_NULL_HANDLE;
  static inline bool is_cached = true;  // all with `cache`

  static inline std::mutex mutex;
  static inline std::set<VkPipelineLayout> layouts;  // each pipeline has its own

  static void reset() {
    count = destroyed = 0;
    layouts.clear();
    most_colours = 0;
    cache = VK_NULL_HANDLE;
    is_cached = true;
  }
  template <typename Info>
  static void add(VkPipelineCache used, std::uint32_t number, const Info* infos) {
    const std::scoped_lock lock(mutex);
    for (std::uint32_t i = 0; i < number; ++i) layouts.insert(infos[i].layout);
    count += static_cast<int>(number);
    is_cached &= used == cache;
  }
  static VkResult call(PFN_vkCreateComputePipelines real, VkDevice device, VkPipelineCache used,
                       std::uint32_t number, const VkComputePipelineCreateInfo* infos,
                       const VkAllocationCallbacks* callbacks, VkPipeline* made) {
    add(used, number, infos);
    return real(device, used, number, infos, callbacks, made);
  }
  static VkResult call(PFN_vkCreateGraphicsPipelines real, VkDevice device, VkPipelineCache used,
                       std::uint32_t number, const VkGraphicsPipelineCreateInfo* infos,
                       const VkAllocationCallbacks* callbacks, VkPipeline* made) {
    add(used, number, infos);
    for (std::uint32_t i = 0; i < number; ++i)
      most_colours = std::max(most_colours.load(), infos[i].pColorBlendState->attachmentCount);
    return real(device, used, number, infos, callbacks, made);
  }
  static void call(PFN_vkDestroyPipeline real, VkDevice device, VkPipeline pipeline,
                   const VkAllocationCallbacks* callbacks) {
    destroyed += pipeline ? 1 : 0;
    real(device, pipeline, callbacks);
  }
};

class PipelinesTest : public YardTest {
 protected:
  PipelinesTest() : YardTest(gpu::kUsualHost, {16, 9}) {
    Compiled::reset();
    for (const gpu::Replacement& replacement :
         {BRUME_INTERPOSED(Compiled, CreateComputePipelines),
          BRUME_INTERPOSED(Compiled, CreateGraphicsPipelines), BRUME_INTERPOSED(Compiled, DestroyPipeline)})
      replacements_.push_back(replacement);
  }
  void make_yard() {
    make({32, 16, 32}, 0.25f);
    smoke(1, {3, 0.6f, 3}, 500, 100);
    advance(40);
  }
  void draw_some() {
    for (int frame = 0; frame < 3; ++frame) draw({1, 2, 1}, {1, -0.1f, 1}, 0.7);
  }
  brume_result compile_ahead(const brume_frame_params* frame = nullptr) {
    brume_renderer_params renderer = brume_renderer_defaults();
    renderer.temporal = 1;
    renderer.lights = &kLight;
    renderer.light_count = 1;
    return brume_device_compile(device_, &renderer, frame);
  }
  void destroy() {
    host_.wait();
    EXPECT_OK(brume_renderer_destroy(std::exchange(renderer_, nullptr)));
    EXPECT_OK(brume_device_destroy(std::exchange(device_, nullptr)));
  }
};

TEST_F(PipelinesTest, ASecondRendererCompilesNone) {
  make_yard();
  draw_some();
  const int compiled = Compiled::count;
  EXPECT_GT(compiled, 10);
  brume_renderer* const first = renderer_;
  ASSERT_OK(create_renderer(1));
  draw_some();
  EXPECT_EQ(Compiled::count, compiled);
  host_.wait();
  EXPECT_OK(brume_renderer_destroy(first));
}

TEST_F(PipelinesTest, ARendererThatIsMadeAgainCompilesNone) {
  make_yard();
  draw_some();
  const int compiled = Compiled::count;
  EXPECT_OK(brume_renderer_destroy(renderer_));
  ASSERT_OK(create_renderer(1));
  draw_some();
  EXPECT_EQ(Compiled::count, compiled);
  EXPECT_EQ(Compiled::destroyed, 0);
  destroy();
  EXPECT_EQ(Compiled::destroyed, compiled);
}

// With accumulation over frames, as renderers of yards have.
TEST_F(PipelinesTest, AnotherSizeCompilesNone) {
  make_yard();
  draw_some();
  const int compiled = Compiled::count;
  for (const glm::uvec2 size : {glm::uvec2(17, 9), glm::uvec2(8, 8), glm::uvec2(16, 9)}) {
    resize(size);
    draw_some();
  }
  EXPECT_EQ(Compiled::count, compiled);
}

TEST_F(PipelinesTest, AllUseTheCacheOfTheHost) {
  const VkDevice device = host_.device().device;
  const auto function = [&](const char* name) { return gpu_.vk().GetDeviceProcAddr(device, name); };
  const auto create = reinterpret_cast<PFN_vkCreatePipelineCache>(function("vkCreatePipelineCache"));
  const auto destroy_cache = reinterpret_cast<PFN_vkDestroyPipelineCache>(function("vkDestroyPipelineCache"));
  const VkPipelineCacheCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO, nullptr, 0, 0, nullptr};
  ASSERT_EQ(create(device, &info, nullptr, &cache_), VK_SUCCESS);
  Compiled::cache = cache_;
  make_yard();
  draw_some();
  EXPECT_GT(Compiled::count, 10);
  EXPECT_TRUE(Compiled::is_cached);
  destroy();
  destroy_cache(device, cache_, nullptr);
}

// With holes, accumulation, indirect light, decals and shadows on surfaces, and at every march scale.
TEST_F(PipelinesTest, ACompiledDeviceLeavesNoneToFrames) {
  make_yard();
  const float occluded = 1;
  brume_decal_params decal_params = brume_decal_defaults();
  decal_params.up = &occluded;
  for (std::uint32_t& along : decal_params.size) along = 1;
  const api::Decal decal(context_, decal_params);
  const brume_shown_decal shown = decal.shown();
  ASSERT_OK(compile_ahead());
  const int compiled = Compiled::count;
  EXPECT_GT(compiled, 10);
  brume_event shot = brume_event_defaults(BRUME_EVENT_SHOT, 45);
  shot.u.shot.toward = position_of(sim::position_from_metres({6, 1, 6}));
  append(shot);
  advance(50);
  for (const std::uint32_t scale : {1u, 2u, 4u}) {
    ASSERT_OK(brume_renderer_set_march_scale(renderer_, scale));
    for (const std::uint32_t skip_fine_shadows : {0u, 1u})
      for (const float detail_reduction : {0.0f, 1.0f})
        draw({1, 2, 1}, {1, -0.1f, 1}, 0.8, [&](brume_frame_params& params) {
          params.quality.skip_fine_shadows = skip_fine_shadows;
          params.detail_reduction = detail_reduction;
          params.bounces = 1;
          params.decals = &shown;
          params.decal_count = 1;
          params.shadow_light_count = 1;
          ASSERT_OK(brume_renderer_record(renderer_, field_, &params));
        });
  }
  EXPECT_EQ(Compiled::count, compiled);
  brume_frame_params frame = brume_frame_defaults();
  frame.picture.format = VK_FORMAT_R8G8B8A8_UNORM;
  ASSERT_OK(compile_ahead(&frame));
  EXPECT_EQ(Compiled::count, compiled + 1) << "the layer over the picture";
  frame.picture.format = VK_FORMAT_R32_UINT;
  expect_refused(compile_ahead(&frame), BRUME_ERROR_ARGUMENT, "picture.format");
  destroy();
  EXPECT_EQ(Compiled::destroyed, compiled + 1);
}

class CompiledFramesTest : public PipelinesTest {
 protected:
  void SetUp() override {
    make_yard();
    shown_.push_back(show("cloud.brv", false));
    shown_.push_back(show("fire.brv", true));
    shown_[1].kelvin = 1900;
    shown_[1].position.z = 3.5f;
  }
  /// A volume ahead of the camera.
  brume_shown_volume show(const std::string& name, bool is_hot) {
    grids::GridFile file;
    for (const char* grid : {"density", "temperature"}) {
      file.grids.push_back(grids::generate_cloud(
          {.kind = grids::CloudKind::sphere, .edge = 16, .voxel_size = 0.1, .radius = 0.6}));
      file.grids.back().name = grid;
      if (!is_hot) break;
    }
    const std::string path = (folder_.path() / name).string();
    grids::save_grid_file(path, file).value_or_throw();
    brume_volume_params params = brume_volume_defaults();
    params.file = path.c_str();
    brume_shown_volume shown = volumes_.emplace_back(context_, params).shown();
    shown.position = {2.2f, 1.3f, 2.2f};
    return shown;
  }
  /// Compiles for frames as `change` makes them; these, with smoke and without, then compile none.
  void expect_no_more(const std::function<void(brume_frame_params&)>& change) {
    brume_frame_params like = brume_frame_defaults();
    like.camera.position = {1, 2, 1};
    like.camera.forward = {1, -0.1f, 1};
    change(like);
    const int before = Compiled::count;
    ASSERT_OK(compile_ahead(&like));
    const int compiled = Compiled::count;
    EXPECT_GT(compiled, before);
    // All of its volumes, each alone, and none; in view and behind the camera.
    std::vector<std::pair<std::size_t, std::size_t>> ranges{{0, like.volume_count}, {0, 0}};
    for (std::size_t i = 0; like.volume_count > 1 && i < like.volume_count; ++i) ranges.emplace_back(i, 1);
    for (const float ahead : {1.0f, -1.0f})
      for (const brume_field* field : {static_cast<const brume_field*>(field_), (const brume_field*)nullptr})
        for (const auto& [first, count] : ranges)
          draw({1, 2, 1}, {ahead, -0.1f, ahead}, 0.7, [&, first = first, count = count](auto& params) {
            change(params);
            params.volumes += first;
            params.volume_count = count;
            ASSERT_OK(brume_renderer_set_march_scale(renderer_, count == 1 ? 2 : 1));
            ASSERT_OK(brume_renderer_record(renderer_, field, &params));
            EXPECT_EQ(Compiled::count, compiled) << count << " volumes from " << first << ", ahead " << ahead;
          });
  }
  void show_volumes(brume_frame_params& params, std::size_t count) const {
    params.volumes = shown_.data();
    params.volume_count = count;
  }

  cli::WorkFolder folder_;
  std::vector<api::Volume> volumes_;
  std::vector<brume_shown_volume> shown_;
};

TEST_F(CompiledFramesTest, WithVolumesOfWhichOneGlows) {
  expect_no_more([&](brume_frame_params& params) {
    show_volumes(params, 2);
    params.bounces = 1;
  });
}

TEST_F(CompiledFramesTest, WithAVolumeInAParallelView) {
  expect_no_more([&](brume_frame_params& params) {
    show_volumes(params, 1);
    params.parallel = 1;
    params.frustum = {-3, 3, -2, 2};
    params.depth.far_plane = 100;
  });
}

TEST_F(CompiledFramesTest, WithATank) {
  const float sphere[] = {4, 4, 4, 3};
  const std::uint32_t colour = 0xff80c0ffu;
  brume_tank_params params = brume_tank_defaults();
  for (std::uint32_t& along : params.size) along = 8;
  params.voxel = 0.1f;
  params.spheres = sphere;
  params.colors = &colour;
  params.sphere_count = 1;
  const api::Tank tank(context_, params);
  std::vector<brume_shown_tank> shown(2, tank.shown());
  shown[1].view = BRUME_TANK_VOXELS;
  for (brume_shown_tank& one : shown) one.position = {2.5f, 1.5f, 2.5f};
  expect_no_more([&](brume_frame_params& frame) {
    frame.tanks = shown.data();
    frame.tank_count = shown.size();
  });
}

// Nothing is in view there, and the camera may look out of the world.
TEST_F(PipelinesTest, CompilesWhereverTheCameraIs) {
  make_yard();
  for (const float side : {-1.0f, 1.0f})
    for (const std::uint32_t parallel : {0u, 1u}) {
      brume_frame_params like = brume_frame_defaults();
      like.camera.position = {16384 * side, 16384 * side, 0};
      like.camera.forward = {side, side, 0.1f};
      like.frustum = {999, 1000, -1, 1};
      like.parallel = parallel;
      EXPECT_OK(compile_ahead(&like));
    }
}

TEST_F(PipelinesTest, FramesAreDrawnWhileAnotherThreadCompiles) {
  make_yard();
  brume_result result = BRUME_ERROR_INTERNAL;
  {
    const std::jthread thread([&] { result = compile_ahead(); });
    draw_some();
  }
  EXPECT_EQ(result, BRUME_OK);
  const int compiled = Compiled::count;
  EXPECT_EQ(Compiled::layouts.size(), static_cast<std::size_t>(compiled)) << "a pipeline was compiled twice";
  draw_some();
  EXPECT_EQ(Compiled::count, compiled);
}

// Without smoke in its first frame.
TEST_F(PipelinesTest, ARendererThatPreparesAllCompilesInItsFirstFrame) {
  prepares_all_ = true;
  make({32, 16, 32}, 0.25f);
  advance(1);
  draw({1, 2, 1}, {1, -0.1f, 1}, 0);
  const int compiled = Compiled::count;
  EXPECT_GT(compiled, 10);
  smoke(1, {3, 0.6f, 3}, 500, 100);
  advance(40);
  draw_some();
  ASSERT_OK(brume_renderer_set_march_scale(renderer_, 2));
  draw_some();
  EXPECT_EQ(Compiled::count, compiled);
}

// The surfaces are the host's: no pipeline draws into a G-buffer.
TEST_F(PipelinesTest, NoneDrawsIntoSeveralColours) {
  make_yard();
  draw_some();
  EXPECT_LE(Compiled::most_colours, 1u);
}

/// The names that debuggers show.
struct Named {
  static inline std::set<std::string> objects, passes;
  static inline int depth = 0;
  static VkResult call(PFN_vkSetDebugUtilsObjectNameEXT real, VkDevice device,
                       const VkDebugUtilsObjectNameInfoEXT* info) {
    objects.insert(info->pObjectName);
    return real(device, info);
  }
  static void call(PFN_vkCmdBeginDebugUtilsLabelEXT real, VkCommandBuffer commands,
                   const VkDebugUtilsLabelEXT* label) {
    passes.insert(label->pLabelName);
    ++depth;
    real(commands, label);
  }
  static void call(PFN_vkCmdEndDebugUtilsLabelEXT real, VkCommandBuffer commands) {
    --depth;
    real(commands);
  }
};

TEST_F(PipelinesTest, AndPassesHaveNames) {
  for (const gpu::Replacement& replacement : {BRUME_INTERPOSED(Named, SetDebugUtilsObjectNameEXT),
                                              BRUME_INTERPOSED(Named, CmdBeginDebugUtilsLabelEXT),
                                              BRUME_INTERPOSED(Named, CmdEndDebugUtilsLabelEXT)})
    replacements_.push_back(replacement);
  make_yard();
  draw_some();
  EXPECT_TRUE(Named::objects.contains("march.comp"));
  EXPECT_TRUE(Named::passes.contains("march"));
  EXPECT_EQ(Named::depth, 0);
}

}  // namespace
}  // namespace brume::host
