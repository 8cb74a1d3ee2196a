// The thin lens: what it leaves sharp, and how far it spreads the rest.
#include "reference/render.hpp"
#include "tests/path_tracer/box_medium.hpp"
#include "tests/path_tracer/squares.hpp"

namespace brume::reference {
namespace {

/// A square that emits, before a black sky, at a distance; its width in the picture's pixels above a tenth of
/// its brightness, with a lens that is focused at 4 m.
int width_at(float distance, float aperture) {
  // A tenth of the picture, whatever the distance.
  const scene::Scene scene = lit_square(-distance, 0.1f * distance);
  const auto made = scene_of(scene, {});
  RenderSettings settings;
  settings.size_px = {80, 3};
  scene::Camera camera{{0, 0, 0}, {0, 0, -1}, 2 * std::atan(3.0f / 80)};
  camera.lens = {.aperture = aperture, .focus = 4};
  settings.eyes = {make_eye(camera, settings.size_px)};
  settings.blades = 6;
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
