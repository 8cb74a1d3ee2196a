// Parts of a tank's picture: rows of a sample at a time, other sizes, other exposures.

#include "planning/tank_plan.hpp"
#include "render/tank_renderer.hpp"
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
  void set_view(TankRenderer& renderer, glm::uvec2 size_px) {
    renderer.set_view(planning::plan_tank(scenario_.scene, scenario_.tank, 0, size_px),
                      planning::plan_tank_display(scenario_.scene, size_px));
  }
  std::vector<glm::uvec4> sums(const TankRenderer& renderer) {  // as their bits
    return read_back<glm::uvec4>(renderer.sum());
  }
  std::vector<std::uint32_t> shown(const TankRenderer& renderer) {
    return read_back<std::uint32_t>(renderer.display());
  }
  void add_samples(TankRenderer& renderer, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i)
      runner().run([&](gpu::Recorder& recorder) { renderer.record_samples(recorder, 1); });
  }

  scenario::TankScenario scenario_;
};

TEST_F(TankRowsTest, RowsAddUpToTheSameBitsInBothViews) {
  for (const scene::TankView view : {scene::TankView::spheres, scene::TankView::voxels}) {
    TankRenderer whole(context(), runner(), scenario_.tank, kPictureSize);
    TankRenderer parts(context(), runner(), scenario_.tank, kPictureSize);
    for (TankRenderer* renderer : {&whole, &parts}) {
      renderer->set_kind(view);
      set_view(*renderer, kPictureSize);
    }
    add_samples(whole, 3);
    for (std::uint32_t sample = 0; sample < 3; ++sample)
      for (const std::uint32_t rows : {8u, 24u, 5u}) {
        EXPECT_EQ(parts.samples(), sample);
        runner().run([&](gpu::Recorder& recorder) { parts.record_rows(recorder, rows); });
      }
    EXPECT_EQ(parts.samples(), 3u);
    EXPECT_EQ(parts.rows(), 0u);
    EXPECT_EQ(sums(parts), sums(whole));
    EXPECT_EQ(shown(parts), shown(whole));
  }
}

TEST_F(TankRowsTest, AResizedPictureIsThatOfItsSize) {
  TankRenderer renderer(context(), runner(), scenario_.tank, {16, 9});
  set_view(renderer, {16, 9});
  add_samples(renderer, 2);
  renderer.resize(kPictureSize);
  EXPECT_EQ(renderer.samples(), 0u);
  set_view(renderer, kPictureSize);
  add_samples(renderer, 2);
  TankRenderer other(context(), runner(), scenario_.tank, kPictureSize);
  set_view(other, kPictureSize);
  add_samples(other, 2);
  EXPECT_EQ(sums(renderer), sums(other));
}

TEST_F(TankRowsTest, TheExposureChangesThePictureAndNotItsSamples) {
  TankRenderer renderer(context(), runner(), scenario_.tank, kPictureSize);
  set_view(renderer, kPictureSize);
  add_samples(renderer, 2);
  const auto before = sums(renderer);
  const auto dark = shown(renderer);
  scenario_.scene.exposure = 2;
  renderer.set_display(planning::plan_tank_display(scenario_.scene, kPictureSize));
  runner().run([&](gpu::Recorder& recorder) { renderer.record_display(recorder); });
  EXPECT_EQ(sums(renderer), before);
  EXPECT_NE(shown(renderer), dark);
  const auto bright = shown(renderer);
  set_view(renderer, kPictureSize);
  add_samples(renderer, 2);
  EXPECT_EQ(shown(renderer), bright);
}

}  // namespace
}  // namespace brume::render
