// What is out of view costs nothing, and changes nothing.
#include <cstdlib>

#include "film/playback.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/render/rooms.hpp"

namespace brume::render {
namespace {

/// A floor of 80 m with walls, two lights by the camera and many elsewhere, a sun; a smoke before the camera.
scenario::Scenario wide_stage(bool more_smoke, bool more_lights) {
  constexpr glm::vec3 kDim(0.8f);
  std::vector<scene::Light> lights{scene_light({-2, 2, 2}, kDim), scene_sun({0.4f, -1, -0.5f}, 0.3f)};
  if (more_lights)
    for (int i = 0; i < 12; ++i)
      lights.push_back(scene_light({-35.0f + 6.0f * static_cast<float>(i), 2, 35}, kDim));
  lights.push_back(scene_light({2.5f, 1, 1}, kDim));
  scene::Scene scene =
      scene_of({{{-40, -0.3f, -40}, {40, -0.1f, 40}}, {{-3, -0.1f, -4.2f}, {3, 3, -4}}}, std::move(lights));
  scene.camera = {{0, 1.5f, 5.5f}, {0, 1.2f, 0}, 0.9f};

  scene::Timeline timeline;
  timeline.smoke.voxels = 400;
  timeline.smoke.erosion = 0.6f;
  timeline.smoke.detail = 0;  // it would amplify rounding errors
  timeline.smokes = {{0, {0, 2, 0}, {0, 0.2f, 0}}};
  if (more_smoke)
    for (int i = 0; i < 6; ++i) {
      const glm::vec3 place{-30.0f + 12.0f * static_cast<float>(i), 0.2f, 33};
      timeline.smokes.push_back({0, place + glm::vec3(0, 2, 0), place});
    }
  return scenario_of(std::move(scene), std::move(timeline), {{162, 20, 162}, 0.5f, {-40.3f, -0.6f, -40.3f}});
}

class CullingTest : public gpu::GpuTest {
 protected:
  static constexpr glm::uvec2 kSize{96, 54};
};

// Atlas coordinates of other sizes round otherwise: a value may fall on the other side of a step of 8 bits,
// and a ray may end a sample earlier, which is less than a step, too (SmokeLook::stop). It may also take
// longer steps from another sample on (lib/march.glsl), hence short ones: what they are off by falls with
// their length.
TEST_F(CullingTest, SmokeAndLightsOutOfViewChangeNothing) {
  const scenario::Scenario alone = wide_stage(false, false), crowded = wide_stage(true, true);
  film::Playback a(context(), alone, kSize), b(context(), crowded, kSize);
  a.set_step_scale(0.25f);
  b.set_step_scale(0.25f);
  const image::Image8 with = b.draw(2, 0), without = a.draw(2, 0);
  int most = 0, others = 0;
  for (std::size_t i = 0; i < with.rgba.size(); ++i) {
    const int apart = std::abs(int{with.rgba[i]} - int{without.rgba[i]});
    most = std::max(most, apart);
    others += apart > 0;
  }
  EXPECT_LE(most, 2);
  EXPECT_LE(others, static_cast<int>(with.rgba.size() / 100)) << "of " << with.rgba.size();
  RecordProperty("other_bytes", others);
}

// What was not drawn for a while is rebuilt when it comes into view.
TEST_F(CullingTest, WhatComesIntoViewIsUpToDate) {
  const scenario::Scenario scenario = wide_stage(true, true);
  const scene::Camera toward{{0, 1.5f, 5.5f}, {0, 1.2f, 0}, 0.9f}, away{{0, 1.5f, 5.5f}, {0, 1.2f, 30}, 0.9f};
  film::Playback turning(context(), scenario, kSize), staring(context(), scenario, kSize);
  turning.set_camera(away);
  staring.set_camera(toward);
  EXPECT_NE(turning.draw(0.4, 0).rgba, staring.draw(0.4, 0).rgba);
  turning.draw(1.5, 1);
  staring.draw(1.5, 1);
  turning.set_camera(toward);
  EXPECT_EQ(turning.draw(3, 2).rgba, staring.draw(3, 2).rgba);
}

}  // namespace
}  // namespace brume::render
