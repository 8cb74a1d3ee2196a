// Many frames of a host, in which everything changes: nothing is submitted, nothing leaks; and worlds whose
// smoke is out of view, or more than there is memory for.
#include <array>
#include <random>

#include "tests/host/yard.hpp"
#include "tests/thorough.hpp"

namespace brume::host {
namespace {

const int kFrames = is_thorough("frames") ? 10'000 : 40;

class SoakTest : public YardTest {
 protected:
  static constexpr std::size_t kDecals = 3;
  ~SoakTest() override {
    host_.wait();
    for (brume_decal* decal : decals_) EXPECT_OK(brume_decal_destroy(decal));
    leave();
  }
  /// What smoke takes depends on where it is, not on the number of pixels.
  void make_small(brume_voxel size, float voxel_size) {
    make(size, voxel_size);
    resize({16, 9});
  }
  /// Another decal in the place of one.
  void make_decal(std::size_t i, std::uint32_t edge) {
    const std::vector<float> up(std::size_t{edge} * edge * edge, 0.5f);
    brume_decal_params params = brume_decal_defaults();
    params.up = up.data();
    for (std::uint32_t& along : params.size) along = edge;
    EXPECT_OK(brume_decal_destroy(decals_[i]));
    ASSERT_OK(brume_decal_create(context_.get(), &params, &decals_[i]));
  }
  /// Another level, which lies at `origin`, full of smoke; its walls shadow the renderer's lights.
  void enter(glm::vec3 origin) {
    leave();
    const std::vector<std::uint8_t> empty(std::size_t{32} * 16 * 24 / 8);
    brume_voxels_params params = brume_voxels_defaults();
    params.layout = {{32, 16, 24}, 0.2f, point_of(origin)};
    params.bits = empty.data();
    params.byte_count = empty.size();
    ASSERT_OK(brume_level_create_from_voxels(context_.get(), &params, &other_.level));
    ASSERT_OK(brume_world_create(other_.level, nullptr, &other_.world));
    ASSERT_OK(brume_field_create(other_.level, nullptr, &other_.field));
    brume_event event = brume_event_defaults(BRUME_EVENT_SMOKE, 0);
    event.u.smoke.from = event.u.smoke.at =
        position_of(sim::position_from_metres(glm::dvec3(origin + glm::vec3(3, 1, 2))));
    event.u.smoke.voxels = 2000;
    ASSERT_OK(brume_world_append(other_.world, &event, 1));
    const std::array<brume_point, 3> wall{point_of(origin + glm::vec3(0, 1, 0)),
                                          point_of(origin + glm::vec3(4, 1, 0)),
                                          point_of(origin + glm::vec3(0, 1, 4))};
    set_triangles(wall);
  }
  void leave() {
    brume_state_destroy(other_.state);
    brume_field_destroy(other_.field);
    brume_world_destroy(other_.world);
    brume_level_destroy(other_.level);
    if (other_.level) set_triangles({});
    other_ = {};
  }
  void set_triangles(std::span<const brume_point> points) {
    const std::array<std::uint32_t, 3> indices{0, 1, 2};
    EXPECT_OK(brume_renderer_set_triangles(renderer_, points.data(), points.size(), indices.data(),
                                           points.empty() ? 0 : indices.size()));
  }
  void advance_other() {
    ASSERT_OK(brume_world_step(other_.world));
    brume_state_destroy(other_.state);
    ASSERT_OK(brume_world_state(other_.world, &other_.state));
    ASSERT_OK(brume_field_update(other_.field, other_.state));
  }

  std::array<brume_decal*, kDecals> decals_{};
  struct {
    brume_level* level;
    brume_world* world;
    brume_state* state;
    brume_field* field;
  } other_{};
};

TEST_F(SoakTest, ManyFramesTakeNoMoreMemoryThanSome) {
  make({48, 20, 32}, 0.25f);
  std::mt19937 random(4);
  const auto number = [&](std::size_t below) { return static_cast<std::uint32_t>(random() % below); };
  std::uint64_t first_half = 0, second_half = 0;
  for (int i = 0; i < kFrames; ++i) {
    const auto tick = static_cast<std::uint32_t>(i + 1);
    if (i % 120 == 10)
      smoke(tick, {2.0f + 0.02f * static_cast<float>(number(400)), 0.6f, 3}, 500 + number(1500), 90);
    if (i % 45 == 20) {
      brume_event door = brume_event_defaults(BRUME_EVENT_EDIT, tick);
      door.u.edit = {{24, 1, 10}, {25, 12, 17}, static_cast<std::uint32_t>(i / 45 % 2 == 0)};
      append(door);
    }
    if (i % 50 == 30) resize(kSizes[number(std::size(kSizes))]);
    // Memory is short for a while, in which the size changes, too.
    if (i % 40 == 25) limit(device_bytes() * 3 / 4);
    if (i % 40 == 38) limit(UINT64_MAX);
    if (i % 10 == 0) make_decal(static_cast<std::size_t>(i / 10) % kDecals, 8 + number(24));
    advance(tick);
    // Another level for a while, each time elsewhere.
    glm::vec3 origin(0);
    if (i % 20 >= 6 && i % 20 < 14) {
      origin = glm::vec3(static_cast<float>(i / 20 % 50) * 100.0f - 3000, 0, 50);
      if (!other_.level) enter(origin);
      advance_other();
    } else if (other_.level) {
      leave();
    }
    const float turn = 0.01f * static_cast<float>(i);
    const std::size_t first_decal = i / 5 % 4;  // none at 3
    const auto views = static_cast<std::uint32_t>(1 + i % BRUME_MAX_VIEWS);
    draw(origin + glm::vec3(6 + 3 * std::cos(turn), 1.5f, 4), {std::sin(3 * turn), 0, std::cos(3 * turn)},
         tick / 64.0, [&](brume_frame_params& params) {
           std::vector<brume_shown_decal> shown;
           for (std::size_t decal = first_decal; decal < kDecals; ++decal)
             if (decals_[decal]) shown.push_back(brume_shown_decal_defaults(decals_[decal]));
           for (brume_shown_decal& decal : shown) decal.position = point_of(origin + glm::vec3(6, 1, 4));
           params.decals = shown.data();
           params.decal_count = shown.size();
           for (params.view = 0; params.view < views; ++params.view) {
             ASSERT_OK(brume_renderer_record(renderer_, other_.field ? other_.field : field_, &params));
             params.camera.position.x += 0.1f;
           }
         });
    std::uint64_t& most = i < kFrames / 2 ? first_half : second_half;
    most = std::max<std::uint64_t>(most, memory_.bytes);
    ASSERT_FALSE(HasFatalFailure());
    if (tick % 1000 == 0) {
      std::printf("%u frames: %.1f MB\n", tick, static_cast<double>(memory_.bytes) / 1e6);
      std::fflush(stdout);
    }
  }
  std::printf("%d frames: %.1f MB at most in the first half, %.1f in the second\n", kFrames,
              static_cast<double>(first_half) / 1e6, static_cast<double>(second_half) / 1e6);
  EXPECT_LE(second_half, first_half + (16u << 20)) << "a block";
}

TEST_F(SoakTest, AThousandSmokesOutOfViewTakeLittleMemory) {
  make_small({1024, 16, 1024}, 0.25f);
  for (int i = 0; i < 1000; ++i)
    smoke(1, {5.0f + 7.8f * static_cast<float>(i % 32), 0.6f, 5.0f + 7.8f * static_cast<float>(i / 32)}, 2500,
          1000);
  draw({128, 30, 128}, {0, 1, 0.01f}, 0);
  const std::uint64_t without = device_bytes();
  advance(80);
  draw({128, 30, 128}, {0, 1, 0.01f}, 1.25);
  const std::uint64_t out_of_view = device_bytes();
  std::printf("device memory: %.1f MB without smoke, %.1f with 1,000 smokes out of view\n",
              static_cast<double>(without) / 1e6, static_cast<double>(out_of_view) / 1e6);
  EXPECT_LT(out_of_view, 100'000'000u);
}

TEST_F(SoakTest, MemoryComesBackWhenSmokeIsOutOfViewForLong) {
  make_small({256, 16, 256}, 0.25f);
  for (int i = 0; i < 36; ++i)
    smoke(1, {5.0f + 10 * static_cast<float>(i % 6), 0.6f, 5.0f + 10 * static_cast<float>(i / 6)}, 2500,
          1000);
  advance(80);
  const auto look = [&](glm::vec3 eye, glm::vec3 forward) {
    draw(eye, forward, 1.25);
    return device_bytes();
  };
  const auto away = [&] { return look({32, 30, 32}, {0, 1, 0.01f}); };
  const std::uint64_t before = away(), in_view = look({1, 3, 1}, {1, -0.1f, 1});
  EXPECT_GT(in_view, before + 20'000'000);
  std::uint64_t later = 0;
  for (int i = 0; i < 270; ++i) later = away();
  std::printf("device memory: %.1f MB, %.1f with 36 smokes in view, %.1f later\n",
              static_cast<double>(before) / 1e6, static_cast<double>(in_view) / 1e6,
              static_cast<double>(later) / 1e6);
  EXPECT_LT(later, before + 4'000'000);
}

TEST_F(SoakTest, AllocatedMemoryIsWhatTheHostGave) {
  make_small({64, 16, 64}, 0.25f);
  for (const std::uint32_t tick : {80u, 160u}) {
    smoke(tick - 79, {5, 0.6f, 5}, 20 * tick, 1000);
    advance(tick);
    draw({1, 3, 1}, {1, -0.1f, 1}, tick / 64.0);
    std::uint64_t allocated = 0;
    EXPECT_OK(brume_device_allocated_memory(device_, &allocated));
    EXPECT_EQ(allocated, memory_.bytes);
    EXPECT_GT(allocated, device_bytes());
  }
}

TEST_F(SoakTest, TellsThatMemoryIsShort) {
  make_small({160, 40, 160}, 0.125f);
  std::uint32_t level = 7, is_smoke_missing = 7;
  EXPECT_EQ(brume_renderer_coarseness(renderer_, &level, &is_smoke_missing), BRUME_ERROR_ORDER);
  smoke(1, {5, 0.6f, 5}, 60'000, 1000);
  smoke(1, {14, 0.6f, 14}, 60'000, 1000);
  advance(100);
  const auto draw_and_ask = [&] {
    draw({1, 3, 1}, {1, -0.1f, 1}, 1.5);
    EXPECT_OK(brume_renderer_coarseness(renderer_, &level, &is_smoke_missing));
    return level;
  };
  EXPECT_EQ(draw_and_ask(), 0u);
  const std::uint64_t bytes = device_bytes();
  limit(0);
  for (int i = 0; i < 5; ++i) draw_and_ask();
  EXPECT_GT(level, 0u);
  EXPECT_LT(device_bytes(), bytes);
  limit(UINT64_MAX);
  for (int i = 0; i < 5; ++i) draw_and_ask();
  EXPECT_EQ(level, 0u);
}

}  // namespace
}  // namespace brume::host
