// Debug views of a whole frame: each says something of its own, and none leaves a trace in the image.
#include <algorithm>
#include <optional>
#include <set>

#include "film/playback.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/render/rooms.hpp"

namespace brume::render {
namespace {

using passes::DebugView;

constexpr glm::uvec2 kViewImage{97, 55};

/// A yard with a wall and a box that breaks at 2 s; smoke, two shots through it.
scenario::Scenario yard() {
  scene::Scene scene = scene_of({{{-5, -0.3f, -5}, {5, -0.05f, 5}},
                                 {{-3, -0.05f, -3.2f}, {3, 2.5f, -3}},
                                 {{1.5f, -0.05f, -1}, {1.8f, 1.5f, 1}}},
                                {scene_light({-2, 2.2f, 2}, glm::vec3(6))}, 0.1f);
  scene.materials[0].base_color = {0.6f, 0.45f, 0.3f};
  scene.camera = scene::Camera{{0.5f, 1.7f, 5.5f}, {0, 1, 0}, 0.9f};
  scene::Timeline timeline;
  timeline.smoke.voxels = 700;
  timeline.smoke.erosion = 0.7f;
  timeline.smokes = {{0.1, {0, 2, 0}, {0, 0.4f, 0}}};
  for (const float x : {-0.4f, 0.5f})
    timeline.shots.push_back({1, {x, 1.2f, 5}, {x, 0.8f, -2}, 0.25f, {.stay = 5}});
  timeline.edits.push_back({2, {1.3f, -0.02f, -1.2f}, {2.1f, 1.8f, 1.2f}, false});
  return scenario_of(std::move(scene), std::move(timeline), {{45, 16, 45}, 0.25f, {-5.6f, -0.6f, -5.6f}});
}

class DebugViewsTest : public gpu::GpuTest {
 protected:
  static const scenario::Scenario& scenario() {
    static const scenario::Scenario instance = yard();
    return instance;
  }
  /// One for all tests, which makes each view's pipeline once.
  static film::Playback& playback() {
    static film::Playback instance(context(), scenario(), kViewImage);
    return instance;
  }
  RendererOptions options(std::uint32_t march_scale, bool temporal) const {
    RendererOptions options{kViewImage};
    options.smoke.march_scale = march_scale;
    options.smoke.temporal = temporal;
    return options;
  }
};

TEST_F(DebugViewsTest, EachIsThereAndDiffersFromAllOthers) {
  std::vector<std::vector<std::uint8_t>> images;
  for (std::uint32_t i = 0; i < shared::kViewCount; ++i) {
    const auto view = static_cast<DebugView>(i);
    playback().set_view(view, {});
    const auto image = playback().draw(1.6, 3).rgba;
    EXPECT_EQ(std::count(images.begin(), images.end(), image), 0) << passes::debug_view_name(view);
    images.push_back(image);
    EXPECT_EQ(playback().draw(1.6, 3).rgba, image) << passes::debug_view_name(view);
    std::set<std::uint32_t> colours;
    for (std::size_t p = 0; p < image.size(); p += 4)
      colours.insert(image[p] | std::uint32_t{image[p + 1]} << 8 | std::uint32_t{image[p + 2]} << 16);
    EXPECT_GE(colours.size(), 2u) << passes::debug_view_name(view);
  }
  // A slice elsewhere is another image.
  for (const DebugView view : {DebugView::density, DebugView::light, DebugView::distance}) {
    playback().set_view(view, passes::ViewSlice{1, 0.5f});
    EXPECT_EQ(std::count(images.begin(), images.end(), playback().draw(1.6, 3).rgba), 0)
        << passes::debug_view_name(view);
  }
}

TEST_F(DebugViewsTest, TheImageIsTheSameWhateverWasShownBefore) {
  for (const std::uint32_t scale : {1u, 4u}) {
    film::Playback plain(context(), scenario(), options(scale, false));
    std::optional<film::Playback> of_blocks;
    if (scale > 1) of_blocks.emplace(context(), scenario(), options(scale, false));
    film::Playback& other = of_blocks ? *of_blocks : playback();
    for (std::uint32_t i = 1; i < shared::kViewCount; i += scale) {  // of the lower resolution a few
      const double seconds = 1.6 + 0.1 * i;                          // over the time when a wall breaks
      other.set_view(static_cast<DebugView>(i), {});
      other.draw(seconds - 0.05, 2 * i);
      if (i % 3 != 0) continue;
      other.set_view(DebugView::none, {});
      EXPECT_EQ(other.draw(seconds, i).rgba, plain.draw(seconds, i).rgba) << "after view " << i;
    }
  }
}

TEST_F(DebugViewsTest, AFilmGoesOnAfterAView) {
  film::Playback plain(context(), scenario(), options(4, true)),
      other(context(), scenario(), options(4, true));
  for (std::uint32_t frame = 0; frame < 4; ++frame) {
    const double seconds = 1.2 + frame / 24.0;
    other.set_view(frame == 1 ? DebugView::steps : frame == 2 ? DebugView::holes : DebugView::none, {});
    const auto shown = other.draw(seconds, frame).rgba, expected = plain.draw(seconds, frame).rgba;
    EXPECT_EQ(shown == expected, frame == 0 || frame == 3) << frame;
  }
}

TEST_F(DebugViewsTest, SolidVoxelsFollowTheLevel) {
  playback().set_view(DebugView::solid, {});
  const auto whole = playback().draw(1.9, 0).rgba, broken = playback().draw(2.1, 0).rgba;
  EXPECT_NE(whole, broken);
  EXPECT_EQ(playback().draw(1.9, 0).rgba, whole);
  EXPECT_EQ(playback().draw(2.1, 0).rgba, broken);
}

TEST_F(DebugViewsTest, WithoutSmokeTheSceneIsThere) {
  // Before the first smoke goes off.
  for (std::uint32_t i = 1; i < shared::kViewCount; ++i) {
    playback().set_view(static_cast<DebugView>(i), {});
    const auto image = playback().draw(0, 0).rgba;
    std::set<std::uint8_t> greens;
    for (std::size_t p = 1; p < image.size(); p += 4) greens.insert(image[p]);
    EXPECT_GE(greens.size(), 2u) << passes::debug_view_name(static_cast<DebugView>(i));
  }
}

}  // namespace
}  // namespace brume::render
