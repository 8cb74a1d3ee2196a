// A frame like those before allocates nothing, on the heap or on the device; and every allocation of others
// may fail.
#include <algorithm>
#include <array>
#include <ctime>
#include <vector>

#include "tests/heap.hpp"
#include "tests/host/yard.hpp"
#include "tests/thorough.hpp"

namespace brume::host {
namespace {

// How many allocations fail, spread over all of them, and in how many tests, which may be of several
// processes (GTEST_TOTAL_SHARDS).
const bool kEvery = is_thorough("faults");
const int kFaults = kEvery ? 320 : 4, kParts = kEvery ? 16 : 1;

/// Without the validation layers, which allocate with every command.
class HeapTest : public YardTest {
 protected:
  // Frames in which the camera turns there and back: two of them, the least that updates all bounces.
  static constexpr int kCycle = 4;

  /// What a frame allocates does not depend on its number of pixels.
  HeapTest() : YardTest(gpu::HostKind::without_layers, {16, 9}) {}

  static double thread_milliseconds() {
    std::timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
  }

  brume_result record(const brume_frame_params& params) {
    if (views_ == 1) return brume_renderer_record(renderer_, field_, &params);
    std::array<brume_frame_params, BRUME_MAX_VIEWS> views;
    std::array<const brume_frame_params*, BRUME_MAX_VIEWS> pointers{};
    for (std::uint32_t i = 0; i < views_; ++i) {
      views[i] = params;
      views[i].view = i;
      views[i].camera.position.x += 0.1f * static_cast<float>(i);
      pointers[i] = &views[i];
    }
    return brume_renderer_record_views(renderer_, field_, pointers.data(), views_);
  }
  /// After two cycles of the camera for each view the next one allocates nothing: by then every view has had
  /// the memory of all frames in flight.
  void expect_steady(std::uint32_t first_tick, const std::function<void(brume_frame_params&)>& add) {
    int allocations = 0, of_device = 0;
    std::vector<double> milliseconds;
    const int first = 2 * static_cast<int>(views_) * kCycle;
    for (int i = 0; i < first + kCycle; ++i) {
      const std::uint32_t tick = first_tick + static_cast<std::uint32_t>(i / 4);
      advance(tick);
      const float turn = 0.02f * static_cast<float>(std::abs(i % kCycle - kCycle / 2));
      draw({4, 1.5f, 1}, {std::sin(turn), -0.1f, std::cos(turn)}, first_tick / 64.0 + i / 256.0,
           [&](brume_frame_params& params) {
             add(params);
             const int before = memory_.allocations;
             Heap::allocations = 0;
             Heap::counts = true;
             const double begin = thread_milliseconds();
             const brume_result result = record(params);
             Heap::counts = false;
             milliseconds.push_back(thread_milliseconds() - begin);
             EXPECT_OK(result);
             if (i < first) return;
             allocations += Heap::allocations;
             of_device += memory_.allocations - before;
           });
      ASSERT_FALSE(HasFailure());
    }
    const auto last = milliseconds.end() - kCycle;
    std::nth_element(last, last + kCycle / 2, milliseconds.end());
    std::printf("%.3f ms of processor time to record a frame\n", last[kCycle / 2]);
    EXPECT_EQ(allocations, 0);
    EXPECT_EQ(of_device, 0);
  }

  std::uint32_t views_ = 1;  ///< Of a frame.
};

TEST_F(HeapTest, SteadyFramesOfOneSmoke) {
  make({48, 20, 48}, 0.25f);
  smoke(1, {4, 0.6f, 5}, 2500, 6400);
  expect_steady(300, [](brume_frame_params&) {});
}

TEST_F(HeapTest, SteadyFramesOfSeveralViews) {
  make({48, 20, 48}, 0.25f);
  smoke(1, {4, 0.6f, 5}, 2500, 6400);
  views_ = 3;
  expect_steady(300, [](brume_frame_params&) {});
}

TEST_F(HeapTest, SteadyFramesOfManySmokesAtHalfResolution) {
  make({40, 16, 40}, 0.25f, 2);
  for (int i = 0; i < 16; ++i)
    smoke(1, {1.25f + 2.5f * static_cast<float>(i % 4), 0.6f, 1.25f + 2.5f * static_cast<float>(i / 4)}, 250,
          6400);
  expect_steady(300, [](brume_frame_params&) {});
}

TEST_F(HeapTest, SteadyFramesOfHolesLightsShadowsAndBounces) {
  make({48, 20, 48}, 0.25f);
  smoke(1, {4, 0.6f, 5}, 2500, 6400);
  brume_event shot = brume_event_defaults(BRUME_EVENT_SHOT, 250);
  shot.u.shot.origin = position_of(sim::position_from_metres({4, 1, 1}));
  shot.u.shot.toward = position_of(sim::position_from_metres({4, 1, 9}));
  shot.u.shot.radius_1024 = 300;
  shot.u.shot.stay_open_ms = 20'000;
  append(shot);
  const brume_light torch{BRUME_LIGHT_SPOT, {3, 1, 3}, {0, 0, 1}, {0.5f, 0.4f, 0.3f}, 0.2f, 0.6f};
  expect_steady(300, [&](brume_frame_params& params) {
    params.lights = &torch;
    params.light_count = 1;
    params.shadow_lights[1] = 1;
    params.shadow_light_count = 2;
    params.bounces = 2;
    params.quality.light_update_fraction = 0.25f;
    params.quality.bounce_update_fraction = 0.125f;
  });
}

TEST_F(HeapTest, SteadyFramesOfDecals) {
  make({48, 20, 48}, 0.25f);
  smoke(1, {4, 0.6f, 5}, 2500, 6400);
  const std::vector<float> up(60, 0.5f), down(60, 0.25f);
  brume_decal_params params = brume_decal_defaults();
  params.up = up.data();
  params.down = down.data();
  for (int axis = 0; axis < 3; ++axis) params.size[axis] = static_cast<std::uint32_t>(3 + axis);
  std::array<brume_decal*, 2> decals{};
  for (brume_decal*& decal : decals) ASSERT_OK(brume_decal_create(context_.get(), &params, &decal));
  std::vector<brume_shown_decal> shown(9, brume_shown_decal_defaults(decals[0]));
  for (std::size_t i = 0; i < shown.size(); ++i) {
    shown[i].decal = decals[i % 2];
    shown[i].position = {1 + static_cast<float>(i), 0.5f, 4};
  }
  int frame = 0;
  expect_steady(300, [&](brume_frame_params& frame_params) {
    frame_params.decals = shown.data();
    // One of two decals is in none of some frames: both stay on the device.
    frame_params.decal_count = ++frame % 3 == 0 ? 1 : shown.size();
  });
  for (brume_decal* decal : decals) EXPECT_OK(brume_decal_destroy(decal));
}

/// A function of the driver, or of tests/gpu/shared_pipelines.hpp, whose own allocations are not counted: it
/// does not expect that they fail.
struct Uncounted {
  template <typename Function, typename... Arguments>
  static VkResult call(Function real, Arguments... arguments) {
    const bool counts = std::exchange(Heap::counts, false);
    const VkResult result = real(arguments...);
    Heap::counts = counts;
    return result;
  }
};

class HeapFaultTest : public HeapTest, public testing::WithParamInterface<int> {
 protected:
  HeapFaultTest() {
    for (const gpu::Replacement& replacement : {BRUME_INTERPOSED(Uncounted, CreateShaderModule),
                                                BRUME_INTERPOSED(Uncounted, CreateDescriptorSetLayout),
                                                BRUME_INTERPOSED(Uncounted, CreatePipelineLayout),
                                                BRUME_INTERPOSED(Uncounted, CreateComputePipelines),
                                                BRUME_INTERPOSED(Uncounted, CreateGraphicsPipelines)})
      replacements_.push_back(replacement);
  }
  /// Calls `call` while allocations are counted.
  template <typename Call>
  static brume_result counted_call(Call call) {
    Heap::counts = true;
    const brume_result result = call();
    Heap::counts = false;
    return result;
  }
  /// A new renderer and its first frames, until all of them worked. Returns how often one failed.
  int draw_all() {
    host_.wait();
    EXPECT_OK(brume_renderer_destroy(renderer_));
    renderer_ = nullptr;
    int failures = 0;
    const auto expect_memory = [&](brume_result result) {
      if (result == BRUME_OK) return;
      ++failures;
      EXPECT_EQ(result, BRUME_ERROR_MEMORY) << brume_last_error();
      EXPECT_STRNE(brume_last_error(), "");
    };
    while (!renderer_ && failures < 2) expect_memory(counted_call([&] { return create_renderer(2); }));
    for (int frame = 0; frame < 3; ++frame)
      for (brume_result result = BRUME_ERROR_MEMORY; result != BRUME_OK && failures < 2;)
        draw({4 + 0.5f * static_cast<float>(frame), 1.5f, 1}, {0, -0.1f, 1}, 5,
             [&](brume_frame_params& params) {
               result = counted_call([&] { return brume_renderer_record(renderer_, field_, &params); });
               expect_memory(result);
             });
    return failures;
  }
};

TEST_P(HeapFaultTest, EveryAllocationMayFail) {
  make({48, 20, 48}, 0.25f);
  smoke(1, {4, 0.6f, 5}, 1000, 6400);
  advance(300);
  Heap::fails_at = 0;
  int allocations = 0;
  for (int i = 0; i < 2; ++i) {
    Heap::allocations = 0;
    EXPECT_EQ(draw_all(), 0);
    allocations = Heap::allocations;
  }
  ASSERT_GT(allocations, 100);
  const VkDeviceSize bytes = memory_.bytes;
  int failed = 0, tried = 0;
  for (int i = GetParam(); i < kFaults; i += kParts) {
    // Spread over all of them, the first among them.
    const int fails_at = 1 + static_cast<int>(std::int64_t{i} * (allocations - 1) / kFaults);
    SCOPED_TRACE("allocation " + std::to_string(fails_at) + " of " + std::to_string(allocations));
    if (kEvery) {
      std::printf("allocation %d of %d\n", fails_at, allocations);
      std::fflush(stdout);
    }
    Heap::allocations = 0;
    Heap::fails_at = fails_at;
    const int failures = draw_all();
    // Its first renderers leave memory to later ones, which then allocate a few times less.
    EXPECT_EQ(failures, Heap::allocations >= fails_at ? 1 : 0);
    failed += failures;
    ++tried;
    Heap::fails_at = 0;
    ASSERT_FALSE(HasFailure());
  }
  EXPECT_GE(failed, tried - tried / 10);
  EXPECT_LE(memory_.bytes, bytes + (64u << 20)) << "four blocks: a spare one of each kind, and staging";
}
INSTANTIATE_TEST_SUITE_P(, HeapFaultTest, testing::Range(0, kParts));

}  // namespace
}  // namespace brume::host
