// The C interface of the renderer draws, in the frames of a host, what the renderer draws by itself.
#include <cstddef>
#include <set>

#include "tests/host/hosted_pair.hpp"

namespace brume::host {
namespace {

using RendererTest = HostedPair;

TEST_F(RendererTest, DrawsWhatTheRendererDraws) {
  // host_test.cpp of tests/render has every number of frames in flight at one resolution.
  HostedSmoke::is_timed = true;
  for (const auto& [march_scale, in_flight] : {std::pair{1u, 3u}, std::pair{2u, 1u}}) {
    make_sides(in_flight, march_scale);
    for (const double seconds : {0.5, 2.0, 3.25, 5.125, 5.25}) draw_both(seconds, march_scale);
    host_->wait();
    for (std::size_t i = 0; i < copies_.size(); i += 2) {
      const Texels expected = texels_of(copies_[i]), drawn = texels_of(copies_[i + 1]);
      EXPECT_GT(std::set(drawn.begin(), drawn.end()).size(), 30u) << "smoke is in view";
      EXPECT_LE(most_apart(expected, drawn), 1 / 255.0) << "frame " << i / 2 << ", scale " << march_scale;
    }
    std::size_t count = 0;
    EXPECT_OK(brume_renderer_timings(smoke_->renderer, nullptr, 0, &count));
    EXPECT_GT(count, 3u);
    TearDown();
    host_.reset();
  }
  HostedSmoke::is_timed = false;
}

// Also while frames that use the images of the size before are in flight.
TEST_F(RendererTest, DrawsTheSameAfterItWasResizedAndBack) {
  make_sides(3, 2);
  draw_both(2.0, 2);
  EXPECT_OK(brume_renderer_resize(smoke_->renderer, 7, 500));
  EXPECT_OK(brume_renderer_resize(smoke_->renderer, kSize.x, kSize.y));
  EXPECT_EQ(brume_renderer_resize(smoke_->renderer, 0, 5), BRUME_ERROR_ARGUMENT);
  draw_both(2.0, 2);
  host_->wait();
  EXPECT_LE(most_apart(texels_of(copies_[2]), texels_of(copies_[3])), 1 / 255.0);
}

TEST_F(RendererTest, RefusesWhatTheHeaderForbids) {
  make_sides(1, 1);
  brume_frame_params params = frame_of(scenario_, 1);
  const auto refused = [&](brume_result expected, const char* words) {
    expect_refused(brume_renderer_record(smoke_->renderer, smoke_->field.get(), &params), expected, words);
  };
  refused(BRUME_ERROR_ARGUMENT, "commands");
  host_->frame([&](VkCommandBuffer commands, std::uint64_t, std::uint64_t) {
    params.commands = commands;
    refused(BRUME_ERROR_ORDER, "frame");
    params.frame_number = 1;
    refused(BRUME_ERROR_ARGUMENT, "depth.view");
    params.depth.view = reinterpret_cast<VkImageView>(1);
    const brume_frame_params good = params;
    const auto refused_with = [&](const char* words, auto change) {
      params = good;
      change(params);
      refused(BRUME_ERROR_ARGUMENT, words);
    };
    refused_with("near_plane", [](auto& p) { p.depth.near_plane = NAN; });
    refused_with("camera.forward", [](auto& p) { p.camera.forward = {0, 0, 0}; });
    refused_with("camera.position", [](auto& p) { p.camera.position.x = INFINITY; });
    refused_with("detail_reduction", [](auto& p) { p.detail_reduction = 1.5f; });
    refused_with("lights", [](auto& p) { p.light_count = 1; });
    refused_with("struct_size", [](auto& p) { p.struct_size = 3; });
  });
  EXPECT_EQ(brume_renderer_record(nullptr, smoke_->field.get(), &params), BRUME_ERROR_HANDLE);
  EXPECT_EQ(brume_device_destroy(smoke_->device), BRUME_ERROR_ORDER);
  EXPECT_EQ(brume_renderer_smoke(smoke_->renderer, nullptr, nullptr), BRUME_ERROR_ORDER);
}

// Callers with an earlier header, whose struct ended before `prepare_all`.
TEST_F(RendererTest, TakesTheParametersOfAnEarlierHeader) {
  make_sides(1, 1);
  brume_renderer_params params = brume_renderer_defaults();
  params.struct_size = offsetof(brume_renderer_params, prepare_all);
  params.prepare_all = ~0u;
  brume_renderer* renderer = nullptr;
  EXPECT_OK(brume_renderer_create(smoke_->device, &params, &renderer));
  EXPECT_OK(brume_renderer_destroy(renderer));
}

TEST_F(RendererTest, DrawsTheSameWhereAllIsPrepared) {
  HostedSmoke::prepares_all = true;
  make_sides(1, 1);
  HostedSmoke::prepares_all = false;
  draw_both(2.0, 1);
  ASSERT_OK(brume_renderer_set_march_scale(smoke_->renderer, 2));
  whole_->set_march_scale(2);
  draw_both(2.0, 2);
  host_->wait();
  expect_same(0);
  expect_same(1);
}

TEST_F(RendererTest, TakesAsMuchDetailAsTheHostWants) {
  make_sides(2, 1);
  draw_both(3.5, 1);
  change_input_ = [](planning::FrameInput& input) { input.smoke.look.detail = 0.25f; };
  change_params_ = [](brume_frame_params& params) { params.detail_reduction = 0.75f; };
  draw_both(3.5, 1);
  change_input_ = [](planning::FrameInput& input) { input.smoke.look.detail = 0; };
  change_params_ = [](brume_frame_params& params) { params.detail_reduction = 1; };
  draw_both(3.5, 1);
  host_->wait();
  const Texels all = expect_same(0), some = expect_same(1), none = expect_same(2);
  EXPECT_GT(most_apart(all, some), 1 / 255.0);
  EXPECT_GT(most_apart(some, none), 1 / 255.0);
}

TEST_F(RendererTest, TakesSettingsOfQuality) {
  make_sides(2, 1);
  draw_both(3.5, 1);
  change_input_ = [](planning::FrameInput& input) {
    input.quality.step_scale = 4;
    input.quality.fine_shadows = false;
    input.quality.light_update_fraction = 0.25f;
  };
  change_params_ = [](brume_frame_params& params) {
    params.quality.step_scale = 4;
    params.quality.skip_fine_shadows = 1;
    params.quality.light_update_fraction = 0.25f;
  };
  draw_both(3.5, 1);
  whole_->set_march_scale(4);
  ASSERT_OK(brume_renderer_set_march_scale(smoke_->renderer, 4));
  draw_both(3.5, 1);
  host_->wait();
  const Texels best = expect_same(0), coarse = expect_same(1), quarter = expect_same(2);
  EXPECT_GT(most_apart(best, coarse), 1 / 255.0);
  EXPECT_GT(most_apart(coarse, quarter), 1 / 255.0);
  EXPECT_EQ(brume_renderer_set_march_scale(smoke_->renderer, 3), BRUME_ERROR_ARGUMENT);
}

}  // namespace
}  // namespace brume::host
