// Parts of a tank's picture: rows of a sample at a time, other sizes, other exposures.

#include "planning/tank_plan.hpp"
#include "render/tank_picture.hpp"
#include "scenario/tank.hpp"
#include "tests/gpu/gpu_test.hpp"

namespace brume::render {
namespace {

// No multiple of a workgroup's 8 pixels.
constexpr glm::uvec2 kPictureSize{53, 37};

class TankRowsTest : public gpu::GpuTest {
 protected:
  TankRowsTest() {
    scenario::TankScenario& made = scenario_;
    made.scene.pack.size = {40, 40, 24};
    made.scene.pack.voxel = 0.02f;
    made.scene.pack.count = 60;
    made.scene.pack.radius = {2, 6};
    made.scene.lights = {{{0.2f, 0.6f, 0.8f}}};
    made.tank = scenario::make_tank(made.scene).value_or_throw();
  }
  bool show(TankPicture& picture, glm::uvec2 size_px) {
    return picture.show(planning::plan_tank(scenario_.scene, scenario_.tank, 0, size_px),
                        planning::plan_tank_display(scenario_.scene, size_px));
  }
  std::vector<glm::uvec4> sums(const TankPicture& picture) {  // as their bits
    return read_back<glm::uvec4>(picture.sampler().sum());
  }
  std::vector<std::uint32_t> shown(const TankPicture& picture) {
    return read_back<std::uint32_t>(picture.display());
  }
  void add_samples(TankPicture& picture, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i)
      runner().run([&](gpu::Recorder& recorder) { picture.record(recorder, {1}); });
  }

  scenario::TankScenario scenario_;
};

TEST_F(TankRowsTest, RowsAddUpToTheSameBitsInBothViews) {
  for (const scene::TankView view : {scene::TankView::spheres, scene::TankView::voxels}) {
    scenario_.scene.view = view;
    TankPicture whole(context(), runner(), scenario_.tank), parts(context(), runner(), scenario_.tank);
    for (TankPicture* picture : {&whole, &parts}) show(*picture, kPictureSize);
    add_samples(whole, 3);
    for (std::uint32_t sample = 0; sample < 3; ++sample)
      for (const std::uint32_t rows : {8u, 24u, 5u}) {
        EXPECT_EQ(parts.samples(), sample);
        runner().run([&](gpu::Recorder& recorder) { parts.record(recorder, {0, rows}); });
      }
    EXPECT_EQ(parts.samples(), 3u);
    EXPECT_EQ(parts.rows(), 0u);
    EXPECT_EQ(sums(parts), sums(whole));
    EXPECT_EQ(shown(parts), shown(whole));
  }
}

TEST_F(TankRowsTest, AResizedPictureIsThatOfItsSize) {
  TankPicture picture(context(), runner(), scenario_.tank);
  show(picture, {16, 9});
  add_samples(picture, 2);
  EXPECT_TRUE(show(picture, kPictureSize));
  EXPECT_EQ(picture.samples(), 0u);
  add_samples(picture, 2);
  TankPicture other(context(), runner(), scenario_.tank);
  show(other, kPictureSize);
  add_samples(other, 2);
  EXPECT_EQ(sums(picture), sums(other));
}

TEST_F(TankRowsTest, TheExposureChangesThePictureAndNotItsSamples) {
  TankPicture picture(context(), runner(), scenario_.tank);
  show(picture, kPictureSize);
  add_samples(picture, 2);
  const auto before = sums(picture);
  const auto dark = shown(picture);
  scenario_.scene.exposure = 2;
  EXPECT_FALSE(show(picture, kPictureSize));
  runner().run([&](gpu::Recorder& recorder) {
    EXPECT_TRUE(picture.record(recorder, {}));
    EXPECT_FALSE(picture.record(recorder, {}));
  });
  EXPECT_EQ(sums(picture), before);
  EXPECT_NE(shown(picture), dark);
  const auto bright = shown(picture);
  picture.restart();
  show(picture, kPictureSize);
  add_samples(picture, 2);
  EXPECT_EQ(shown(picture), bright);
}

}  // namespace
}  // namespace brume::render
