// The thin lens: its opening, what it leaves sharp, and how far it spreads the rest.
#include "reference/lens.hpp"

#include <numbers>

#include "planning/device_camera.hpp"
#include "reference/render.hpp"
#include "tests/path_tracer/box_medium.hpp"
#include "tests/path_tracer/squares.hpp"

namespace brume::reference {
namespace {

TEST(LensTest, PointsFillTheOpeningEvenly) {
  for (const std::uint32_t blades : {0u, 3u, 5u, 6u, 9u}) {
    // In cells of a grid over the opening: the expected counts by a grid that is 64 times finer.
    constexpr int kCells = 12, kFine = 64;
    const double turn = 2 * std::numbers::pi / std::max(blades, 1u);
    const auto inside = [&](double x, double y) {
      if (blades < 3) return x * x + y * y < 1;
      // Of the wedge that it lies in, below the edge between two corners.
      const double angle = std::atan2(x, y), middle = turn * (std::floor(angle / turn) + 0.5);
      return x * std::sin(middle) + y * std::cos(middle) < std::cos(turn / 2);
    };
    std::vector<double> expected(kCells * kCells), counts(kCells * kCells);
    double all = 0;
    for (int i = 0; i < kCells * kFine; ++i)
      for (int k = 0; k < kCells * kFine; ++k)
        if (inside(2 * (i + 0.5) / (kCells * kFine) - 1, 2 * (k + 0.5) / (kCells * kFine) - 1)) {
          ++expected[static_cast<std::size_t>(i / kFine + kCells * (k / kFine))];
          ++all;
        }
    constexpr std::uint32_t kPoints = 1u << 16;
    for (double& count : expected) count *= kPoints / all;
    for (std::uint32_t i = 0; i < kPoints; ++i) {
      Sampler sampler({i, 0}, 0);
      const float u = sampler.random();
      const glm::vec2 p = point_on_lens(blades, {u, sampler.random()});
      const auto cell = [](float at) {
        return std::clamp(static_cast<int>((at + 1) / 2 * kCells), 0, kCells - 1);
      };
      ++counts[static_cast<std::size_t>(cell(p.x) + kCells * cell(p.y))];
    }
    SCOPED_TRACE(blades);
    expect_distribution(counts, expected);
  }
}

/// A square that emits, before a black sky, at a distance; its width in the picture's pixels above a tenth of
/// its brightness, with a lens that is focused at 4 m.
int width_at(float distance, float aperture) {
  // A tenth of the picture, whatever the distance.
  const scene::Scene scene = lit_square(-distance, 0.1f * distance);
  const auto made = scene_of(scene, {});
  RenderSettings settings;
  settings.size_px = {80, 3};
  settings.eyes = {
      {planning::device_camera({{0, 0, 0}, {0, 0, -1}, 2 * std::atan(3.0f / 80)}, settings.size_px),
       {aperture, 4, 6}}};
  settings.samples = 256;
  Render render(*made, settings);
  while (!render.advance(10, [] { return false; })) {
  }
  int wide = 0;
  const auto pixels = render.radiance();
  for (std::size_t x = 0; x < 80; ++x) wide += pixels[80 + x].r > 0.1f;
  return wide;
}

TEST(LensTest, WhatIsInFocusStaysSharp) {
  const int sharp = width_at(4, 0);
  EXPECT_EQ(sharp, 8);
  EXPECT_EQ(width_at(4, 0.2f), sharp);
  EXPECT_EQ(width_at(1.5f, 0), sharp);
  // Elsewhere a point spreads to 2 aperture |1 / focus - 1 / distance| of the picture's half width.
  for (const float distance : {1.5f, 16.0f}) {
    const float circle = 40 * 0.2f * std::abs(1 / 4.0f - 1 / distance);
    const int wide = width_at(distance, 0.2f);
    EXPECT_GT(wide, sharp);
    EXPECT_LE(wide, sharp + 2 * static_cast<int>(std::ceil(circle)));
  }
}

}  // namespace
}  // namespace brume::reference
