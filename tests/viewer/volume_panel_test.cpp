// The panel of volumes: what is clicked and dragged is in the picture and in the saved timeline.
#include <X11/keysym.h>

#include "tests/viewer/panel_test.hpp"

namespace brume::viewer {
namespace {

class VolumePanelTest : public PanelTest {
 protected:
  /// A place of the curve on the display.
  static glm::ivec2 on(const WidgetLine& canvas, glm::vec2 place) {
    const glm::vec2 size(canvas.high_px - canvas.low_px);
    return canvas.low_px + glm::ivec2(glm::round(glm::vec2(place.x, 1 - place.y) * size));
  }
  scene::VolumeOptions saved_volume() { return saved().volumes.at(0); }
};

TEST_F(VolumePanelTest, TheCurveIsDrawnAndDraggedAndSaved) {
  run();
  click("Smoke");  // folds, so that the panel is short
  click("Volumes");
  click("fog.brv");
  click("##opacity set");
  const WidgetLine canvas = widget("##curve");
  click(on(canvas, {0.5f, 0.25f}));  // a new point
  // Drag it.
  move_to(on(canvas, {0.5f, 0.25f}));
  program_->button(1, true);
  program_->wait_for_frames(2);
  for (const float part : {0.3f, 0.6f, 1.0f})
    move_to(on(canvas, glm::mix(glm::vec2(0.5f, 0.25f), glm::vec2(0.25f, 0.75f), part)));
  program_->button(1, false);
  program_->wait_for_frames(3);
  click(on(canvas, {0.75f, 0.5f}));     // another one,
  click(on(canvas, {0.75f, 0.5f}), 3);  // removed
  const scene::VolumeOptions volume = saved_volume();
  ASSERT_EQ(volume.opacity.size(), 3u);
  EXPECT_EQ(volume.opacity[0], (scene::OpacityPoint{0, 0}));
  EXPECT_NEAR(volume.opacity[1].at, 0.25f, 0.02f);
  EXPECT_NEAR(volume.opacity[1].opacity, 0.75f, 0.02f);
  EXPECT_EQ(volume.opacity[2], (scene::OpacityPoint{1, 1}));
}

TEST_F(VolumePanelTest, ChoicesShowAtOnceAndCanBeUndone) {
  run();
  program_->tap(XK_p);
  click("Smoke");
  click("Volumes");
  click("fog.brv");
  click("##density grid");
  click("fuel");
  click("##opacity set");
  ASSERT_TRUE(program_->wait_for_best());
  const image::Image8 plain = program_->contents();
  click("##colour map");
  click("inferno");
  ASSERT_TRUE(program_->wait_for_best());
  // Left of the panel, without the lines of text above and below.
  const auto difference = [&](const image::Image8& a, const image::Image8& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i)
      if (i / 4 % a.width < 300 && i / 4 / a.width > 200 && i / 4 / a.width < 500)
        sum += std::abs(int{a.rgba[i]} - int{b.rgba[i]});
    return sum / static_cast<double>(a.width * a.height);
  };
  EXPECT_GT(difference(plain, program_->contents()), 0.5);
  move_to({100, 300});
  program_->key(XK_Control_L, true);
  program_->tap(XK_z);
  program_->key(XK_Control_L, false);
  ASSERT_TRUE(program_->wait_for_best());
  EXPECT_LT(difference(plain, program_->contents()), 0.2);
  const scene::VolumeOptions volume = saved_volume();
  EXPECT_EQ(volume.density, "fuel");
  EXPECT_EQ(volume.color_map.name, "");
  EXPECT_EQ(volume.opacity.size(), 2u);
}

TEST_F(VolumePanelTest, ColoursAreAddedAndMoved) {
  run();
  click("Smoke");
  click("Volumes");
  click("fog.brv");
  click("##colour map");
  click("own colours");
  const WidgetLine bar = widget("##colours");
  click(on(bar, {0.3f, 0.5f}));
  move_to(on(bar, {0.3f, 0.5f}));
  program_->button(1, true);
  program_->wait_for_frames(2);
  for (const float at : {0.31f, 0.33f, 0.35f}) move_to(on(bar, {at, 0.5f}));
  program_->button(1, false);
  program_->wait_for_frames(3);
  click(on(bar, {0.5f, 0.5f}), 3);  // removes the middle one
  const scene::VolumeOptions volume = saved_volume();
  ASSERT_EQ(volume.color_map.points.size(), 9u);
  EXPECT_NEAR(volume.color_map.points[3].at, 0.35f, 0.02f);
  EXPECT_EQ(volume.color_map.points[4].at, 0.375f);
  EXPECT_EQ(volume.color_map.points[5].at, 0.625f);
}

}  // namespace
}  // namespace brume::viewer
