// Pipelines belong to the device: what one renderer has compiled, no other compiles again.
#include "tests/host/yard.hpp"

namespace brume::host {
namespace {

/// Pipelines that are compiled, and what with.
struct Compiled {
  static inline int count = 0, destroyed = 0;
  static inline std::uint32_t most_colours = 0;
  static inline VkPipelineCache cache = VK_NULL_HANDLE;
  static inline bool is_cached = true;  // all with `cache`

  static void reset() {
    count = destroyed = 0;
    most_colours = 0;
    cache = VK_NULL_HANDLE;
    is_cached = true;
  }
  static VkResult call(PFN_vkCreateComputePipelines real, VkDevice device, VkPipelineCache used,
                       std::uint32_t number, const VkComputePipelineCreateInfo* infos,
                       const VkAllocationCallbacks* callbacks, VkPipeline* made) {
    count += static_cast<int>(number);
    is_cached &= used == cache;
    return real(device, used, number, infos, callbacks, made);
  }
  static VkResult call(PFN_vkCreateGraphicsPipelines real, VkDevice device, VkPipelineCache used,
                       std::uint32_t number, const VkGraphicsPipelineCreateInfo* infos,
                       const VkAllocationCallbacks* callbacks, VkPipeline* made) {
    count += static_cast<int>(number);
    is_cached &= used == cache;
    for (std::uint32_t i = 0; i < number; ++i)
      most_colours = std::max(most_colours, infos[i].pColorBlendState->attachmentCount);
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
  PipelinesTest() : YardTest(true, {16, 9}) {
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

// The surfaces are the host's: no pipeline draws into a G-buffer.
TEST_F(PipelinesTest, NoneDrawsIntoSeveralColours) {
  make_yard();
  draw_some();
  EXPECT_LE(Compiled::most_colours, 1u);
}

}  // namespace
}  // namespace brume::host
