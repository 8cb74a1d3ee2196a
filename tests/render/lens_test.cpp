// Lens and shutter in real time: pictures that follow from geometry.
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <numbers>

#include "film/playback.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/render/rooms.hpp"

namespace brume::render {
namespace {

constexpr glm::uvec2 kSize{96, 5};
constexpr std::uint32_t kSamples = 256;
/// Five standard errors of a fraction of the samples: of 16 x 16 cells, each with a sample, at most the 48
/// along an edge that crosses the square are undecided, with a variance of at most 1/4 each.
const double kError = 5 * std::sqrt(48 / 4.0) / kSamples;

/// A picture whose middle row is horizontal and 2 m wide at a distance of 1 m.
scene::Camera camera() {
  return {{0, 0, 0}, {0, 0, -1}, 2 * std::atan(static_cast<float>(kSize.y) / static_cast<float>(kSize.x))};
}

/// A black box that emits, in the dark. Thin ones have no sides to see.
scene::Scene glowing(glm::vec3 low, glm::vec3 high) {
  scene::Scene scene;
  add_box(scene.meshes.emplace_back(), low, high);
  scene::Material material;
  material.base_color = glm::vec3(0);
  material.emission = glm::vec3(1);
  scene.materials.push_back(material);
  scene.objects.push_back({"box", 0, 0});
  scene.camera = camera();
  return scene;
}

scenario::Scenario dark(scene::Scene scene) {
  scene::Timeline timeline;
  timeline.sky = plain_sky(0);
  return scenario_of(std::move(scene), std::move(timeline), {{8, 8, 8}, 1, glm::vec3(-4)});
}

class LensTest : public gpu::GpuTest {
 protected:
  /// Radiance along the middle row.
  static std::vector<double> row(const scenario::Scenario& scenario, double seconds = 0) {
    RendererOptions options{kSize};
    options.smoke.record_entries = true;
    film::Playback playback(context(), scenario, options);
    playback.set_samples(kSamples);
    const image::LayeredImage image = playback.draw_layers(seconds, 0);
    std::vector<double> row;
    for (const image::Layer& layer : image.layers)
      if (layer.name == "R")
        for (std::uint32_t x = 0; x < kSize.x; ++x)
          row.push_back(double{glm::unpackHalf1x16(
              std::get<std::vector<std::uint16_t>>(layer.values)[kSize.x * (kSize.y / 2) + x])});
    return row;
  }
  /// Where a pixel's middle is at a distance of 1 m.
  static double place(std::uint32_t x) { return (x + 0.5) / kSize.x * 2 - 1; }
};

TEST_F(LensTest, AnEdgeOutOfFocusIsBlurredByTheShapeOfTheOpening) {
  for (const bool near : {false, true}) {
    // All of the right half, at a distance.
    const float z = near ? -1.5f : -12;
    scene::Scene scene = glowing({0, -40, z - 1e-4f}, {80, 40, z});
    scene.camera->lens = {.aperture = 0.8f, .focus = 3};
    const auto found = row(dark(std::move(scene)));
    // Radius of the circle that a point of it becomes.
    const double circle = 0.8 * std::abs(1 / 3.0 - 1 / double{-z});
    for (std::uint32_t x = 0; x < kSize.x; ++x) {
      // The part of a disk on one side of a line.
      const double at = std::clamp(place(x) / circle, -1.0, 1.0);
      const double expected = 1 - (std::acos(at) - at * std::sqrt(1 - at * at)) / std::numbers::pi;
      // A pixel is the mean over its width; the profile bends by less than 2 / pi over a radius.
      const double bend = 2 / std::numbers::pi * (2.0 / kSize.x) / circle;
      EXPECT_NEAR(found[x], expected, kError + bend) << x << (near ? " near" : " far");
    }
  }
}

TEST_F(LensTest, WhatIsInFocusIsAsSharpAsWithAPinhole) {
  scene::Scene scene = glowing({0, -40, -3.0001f}, {80, 40, -3});
  scene.camera->lens = {.aperture = 0.8f, .focus = 3};
  const auto found = row(dark(std::move(scene)));
  for (std::uint32_t x = 0; x < kSize.x; ++x) EXPECT_NEAR(found[x], x >= kSize.x / 2 ? 1 : 0, 1e-3) << x;
}

TEST_F(LensTest, WhatMovesIsSeenAsLongAsItIsThere) {
  scene::Scene scene = glowing({-0.25f, -40, -2.1f}, {0.25f, 40, -2});
  scenario::Scenario scenario = dark(std::move(scene));
  scene::Carrier carrier;
  carrier.name = carrier.object = "box";
  carrier.keys = {{0, {-1, 0, 0}, {}}, {1, {1, 0, 0}, {}}};
  scenario.timeline.carriers = {carrier};
  scenario.camera.shutter = 0.7f;
  const double begin = 0.1;
  const auto found = row(scenario, begin);
  // Its front is 2 m away; nothing of its sides is seen but near its edges.
  constexpr int kSteps = 4096;
  for (std::uint32_t x = 0; x < kSize.x; ++x) {
    double seen = 0, near = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double time = begin + double{scenario.camera.shutter} * (i + 0.5) / kSteps;
      const double off = std::abs(2 * place(x) - double{scene::pose_at(carrier, time)[3].x});
      seen += off < 0.25;
      // A pixel's width and, of the sides, what perspective shows of 0.1 m.
      near += std::abs(off - 0.25) < 2.0 / kSize.x + 0.05;
    }
    EXPECT_NEAR(found[x], seen / kSteps, near / kSteps + 2.0 / kSamples) << x;
  }
  // Without a shutter it is where it is.
  scenario.camera.shutter = 0;
  const auto still = row(scenario, begin);
  EXPECT_GT(*std::ranges::max_element(still), 0.99);
}

TEST_F(LensTest, SamplesSmoothEdges) {
  // An edge through the middle of a pixel.
  const float off = 0.5f * 2 / static_cast<float>(kSize.x) * 3;
  const auto found = row(dark(glowing({off, -40, -3.0001f}, {80, 40, -3})));
  EXPECT_NEAR(found[kSize.x / 2], 0.5, kError);
  EXPECT_EQ(found[kSize.x / 2 - 1], 0);
  EXPECT_NEAR(found[kSize.x / 2 + 1], 1, 1e-3);
}

}  // namespace
}  // namespace brume::render
