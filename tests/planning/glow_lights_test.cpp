// Light of flames: its power against that of a transparent and of an opaque ball.
#include "planning/glow_lights.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "grids/generate.hpp"
#include "planning/blackbody.hpp"

namespace brume::planning {
namespace {

constexpr double kRadius = 1.5;  // [m]

/// A ball that is dense and as hot as the options say, 0.125 m a voxel.
volumes::VolumeAt hot_ball() {
  grids::CloudSettings settings;
  settings.kind = grids::CloudKind::sphere;
  settings.edge = 32;
  settings.voxel_size = 0.125;
  settings.radius = kRadius;
  settings.edge_width = 0;
  const grids::Grid grid = grids::generate_cloud(settings);
  auto frame = std::make_shared<volumes::VolumeFrame>();
  frame->density = std::move(grids::make_brick_volume(grid)).value_or_throw();
  frame->heat = std::move(grids::make_brick_volume(grid)).value_or_throw();
  frame->glow = grids::find_glow(*frame->heat, frame->density);
  volumes::VolumeAt at;
  at.frame = frame;
  at.world_from_density = at.world_from_heat = glm::mat4(frame->heat->world_from_voxel);
  return at;
}

scene::VolumeOptions options_of(float extinction) {
  scene::VolumeOptions options;
  options.extinction = extinction;
  options.kelvin = kUnitGlow;
  options.emission = 2;
  options.albedo = glm::vec3(0);
  return options;
}

/// Of all lights together [W/sr]; red, which no eye's curve cuts off.
double intensity_of(const std::vector<shared::Light>& lights) {
  double sum = 0;
  for (const shared::Light& light : lights) sum += double{light.intensity.r};
  return sum;
}

const double kRadiance = 2 * double{blackbody_color(kUnitGlow).r};

// Every point is seen: radiance per metre times volume.
TEST(GlowLights, OfATransparentBallHaveThePowerOfItsVolume) {
  const double volume = 4.0 / 3 * 3.14159265 * kRadius * kRadius * kRadius;
  const auto lights = glow_lights(options_of(0.02f), hot_ball(), 0, 1, true);
  ASSERT_FALSE(lights.empty());
  // The ball is of voxels, and absorbs 3/4 of extinction times radius.
  EXPECT_NEAR(intensity_of(lights), 0.02 * kRadiance * volume, 0.05 * 0.02 * kRadiance * volume);
}

// Its surface is seen: radiance times the area of a disc. Divided into balls it has more surface: 8 of an
// eighth of the volume have twice as much.
TEST(GlowLights, OfAnOpaqueBallHaveThePowerOfItsSurface) {
  const double disc = 3.14159265 * kRadius * kRadius;
  const double found = intensity_of(glow_lights(options_of(40), hot_ball(), 0, 1, true));
  EXPECT_GT(found, 0.9 * kRadiance * disc);
  EXPECT_LT(found, 2 * kRadiance * disc);
}

// What is only scattered leaves in the end, however dense the ball is.
TEST(GlowLights, LoseNothingToScattering) {
  const double volume = 4.0 / 3 * 3.14159265 * kRadius * kRadius * kRadius;
  for (const float extinction : {0.02f, 1.0f, 40.0f}) {
    scene::VolumeOptions options = options_of(extinction);
    options.albedo = glm::vec3(1);
    const double emitted = double{extinction} * kRadiance * volume;
    EXPECT_NEAR(intensity_of(glow_lights(options, hot_ball(), 0, 1, true)), emitted, 0.05 * emitted);
    // Half of what is scattered is absorbed: less than with all of it, more than with none.
    options.albedo = glm::vec3(0.5f);
    const double some = intensity_of(glow_lights(options, hot_ball(), 0, 1, true));
    EXPECT_LT(some, intensity_of(glow_lights(options_of(extinction), hot_ball(), 0, 1, true)) * 2);
    EXPECT_GT(some, intensity_of(glow_lights(options_of(extinction), hot_ball(), 0, 1, true)));
  }
}

TEST(GlowLights, LieInTheBall) {
  const volumes::VolumeAt ball = hot_ball();
  const glm::vec3 middle(0);  // as clouds are made
  for (const shared::Light& light : glow_lights(options_of(1), ball, 0, 1, true)) {
    EXPECT_LT(glm::distance(light.position_world, middle) + light.radius, 1.5f * static_cast<float>(kRadius));
    EXPECT_GT(light.range, 1);
  }
}

TEST(GlowLights, AreFiniteForAnyTemperature) {
  const volumes::VolumeAt ball = hot_ball();
  for (const float kelvin : {0.0f, 1e-30f, 1.0f, 399.0f, 401.0f, 1e6f, 1e38f})
    for (const float extinction : {1e-30f, 1.0f, 1e12f}) {
      scene::VolumeOptions options = options_of(extinction);
      options.kelvin = kelvin;
      options.emission = 1e6f;
      for (const shared::Light& light : glow_lights(options, ball, 0, 1, true)) {
        EXPECT_TRUE(std::isfinite(light.intensity.r + light.intensity.g + light.intensity.b + light.range))
            << kelvin;
        EXPECT_GE(std::min({light.intensity.r, light.intensity.g, light.intensity.b}), 0) << kelvin;
      }
    }
}

TEST(GlowLights, AreNoneWhereNothingGlows) {
  volumes::VolumeAt ball = hot_ball();
  scene::VolumeOptions dark = options_of(1);
  dark.emission = 0;
  EXPECT_TRUE(glow_lights(dark, ball, 0, 1, true).empty());
  scene::VolumeOptions cold = options_of(1);
  cold.kelvin = 300;
  EXPECT_TRUE(glow_lights(cold, ball, 0, 1, true).empty());
  ball.frame.reset();
  EXPECT_TRUE(glow_lights(options_of(1), ball, 0, 1, true).empty());
}

}  // namespace
}  // namespace brume::planning
