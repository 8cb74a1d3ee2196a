// The panels of masks, decals and carriers: what is clicked is in the picture and in the saved timeline.
#include <X11/keysym.h>

#include "scene/files/timeline_reader.hpp"
#include "tests/viewer/panel_test.hpp"

namespace brume::viewer {
namespace {

class EffectsPanelTest : public PanelTest {
 protected:
  /// The pixels left of the panels, without the lines of text above and below, that differ from before.
  static std::size_t differing(const image::Image8& a, const image::Image8& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.rgba.size(); i += 4)
      if (i / 4 % a.width < 300 && i / 4 / a.width > 200 && i / 4 / a.width < 500)
        count += std::abs(int{a.rgba[i]} - int{b.rgba[i]}) > 4;
    return count;
  }
  image::Image8 best() {
    EXPECT_TRUE(program_->wait_for_best());
    return program_->contents();
  }
};

TEST_F(EffectsPanelTest, ASteeredCarrierGetsAKeyThere) {
  run("busy.toml", {"--time", "0"});  // paused
  const image::Image8 before = best();
  click("Smoke");  // folds, so that the panel is short
  click("Carriers");
  click("steer (C)");
  const image::Image8 begun = best();
  EXPECT_GT(differing(before, begun), 1000u);  // of another camera
  program_->key(XK_space, true);
  program_->wait_for_frames(5);
  program_->key(XK_space, false);
  click("move key (K)");
  move_to({100, 300});
  program_->tap(XK_Escape);
  EXPECT_LT(differing(before, best()), 90000u);
  const scene::Timeline timeline = saved();
  ASSERT_EQ(timeline.carriers.size(), 2u);
  ASSERT_EQ(timeline.carriers[0].keys.size(), 2u);
  EXPECT_EQ(timeline.carriers[0].keys[0].time, 0);
  // Straight up from the path.
  const scene::Carrier path = scene::load_timeline(folder_.path() / "busy.toml").value_or_throw().carriers[0];
  const scene::CarrierKey first = scene::key_at(path, 1.0 / 64);
  EXPECT_GT(timeline.carriers[0].keys[0].position_world.y, first.position_world.y);
  EXPECT_EQ(timeline.carriers[0].keys[0].position_world.x, first.position_world.x);
}

TEST_F(EffectsPanelTest, DecalsHideAndShowAndKeepTheirSettings) {
  run("busy.toml", {"--time", "0"});  // paused
  click("Smoke");
  click("Decals");
  const image::Image8 shown = best();
  click("show (B)");
  const image::Image8 hidden = best();
  EXPECT_GT(differing(shown, hidden), 50u);
  move_to({100, 300});
  program_->tap(XK_b);
  EXPECT_LT(differing(shown, best()), 10u);
  // A click into the slider of the strength sets it to the middle.
  click("fog.brv");
  click("##strength ");
  const image::Image8 weaker = best();
  EXPECT_GT(differing(shown, weaker), 20u);
  const scene::Timeline timeline = saved();
  ASSERT_EQ(timeline.decals.size(), 2u);
  EXPECT_NEAR(timeline.decals[0].strength, 0.5f, 0.05f);
  EXPECT_EQ(timeline.decals[0].gamma, scene::DecalOptions().gamma);
}

}  // namespace
}  // namespace brume::viewer
