// A frame like those before allocates nothing: on the heap, on the device.
#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <new>
#include <vector>

#include "tests/host/yard.hpp"

namespace {

/// Allocations on the heap of this thread, while they are counted.
struct Heap {
  static inline thread_local bool counts = false;
  static inline thread_local int allocations = 0;
};

void* allocate(std::size_t size, std::size_t alignment) {
  if (Heap::counts) ++Heap::allocations;
  void* const memory = std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (!memory) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) {
  return allocate(size, 16);
}
void* operator new[](std::size_t size) {
  return allocate(size, 16);
}
void* operator new(std::size_t size, std::align_val_t a) {
  return allocate(size, static_cast<std::size_t>(a));
}
void* operator new[](std::size_t size, std::align_val_t a) {
  return allocate(size, static_cast<std::size_t>(a));
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace brume::host {
namespace {

/// Without the validation layers, which allocate with every command.
class SteadyTest : public YardTest {
 protected:
  static constexpr int kCycle = 16;  // frames in which the camera turns there and back

  SteadyTest() : YardTest(false) {}

  static double thread_milliseconds() {
    std::timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
  }

  /// After two cycles of the camera the third allocates nothing.
  void expect_steady(std::uint32_t first_tick, const std::function<void(brume_frame_params&)>& add) {
    int allocations = 0, of_device = 0;
    std::vector<double> milliseconds;
    for (int i = 0; i < 3 * kCycle; ++i) {
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
             const brume_result result = brume_renderer_record(renderer_, field_, &params);
             Heap::counts = false;
             milliseconds.push_back(thread_milliseconds() - begin);
             EXPECT_OK(result);
             if (i < 2 * kCycle) return;
             allocations += Heap::allocations;
             of_device += memory_.allocations - before;
           });
      ASSERT_FALSE(HasFailure());
    }
    const auto third = milliseconds.end() - kCycle;
    std::nth_element(third, third + kCycle / 2, milliseconds.end());
    std::printf("%.3f ms of processor time to record a frame\n", third[kCycle / 2]);
    EXPECT_EQ(allocations, 0);
    EXPECT_EQ(of_device, 0);
  }
};

TEST_F(SteadyTest, OneSmoke) {
  make({48, 20, 48}, 0.25f);
  smoke(1, {4, 0.6f, 5}, 2500, 6400);
  expect_steady(300, [](brume_frame_params&) {});
}

TEST_F(SteadyTest, ManySmokesAtHalfResolution) {
  make({80, 16, 80}, 0.25f, 2);
  for (int i = 0; i < 64; ++i)
    smoke(1, {1.25f + 2.5f * static_cast<float>(i % 8), 0.6f, 1.25f + 2.5f * static_cast<float>(i / 8)}, 250,
          6400);
  expect_steady(300, [](brume_frame_params&) {});
}

TEST_F(SteadyTest, HolesLightsShadowsAndBounces) {
  make({48, 20, 48}, 0.25f);
  smoke(1, {4, 0.6f, 5}, 2500, 6400);
  brume_event shot = brume_event_defaults(BRUME_EVENT_SHOT, 250);
  shot.u.shot.origin = position_of(sim::position_from_metres({4, 1, 1}));
  shot.u.shot.toward = position_of(sim::position_from_metres({4, 1, 9}));
  shot.u.shot.radius = 300;
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

}  // namespace
}  // namespace brume::host
