#include "planning/device_lights.hpp"

#include <gtest/gtest.h>

namespace brume::planning {
namespace {

TEST(DeviceLights, EndWhereTheirIrradianceIsTheLeast) {
  scene::Light light;
  light.intensity = {1, 4, 2};
  for (const float least : {0.01f, 1e-4f, 1e-8f}) {
    light.least = least;
    const float range = device_lights({light}, 0).at(0).range;
    EXPECT_NEAR(4 / (range * range), least, 1e-5f * least);
  }
}

TEST(DeviceLights, PointLightsHaveSixLayersEachAndTheFirstSunItsOwnMap) {
  std::vector<scene::Light> lights(5);
  lights[1].kind = lights[3].kind = scene::LightKind::directional;
  const auto layers = [&](std::uint32_t max_layers) {
    std::vector<std::uint32_t> found;
    for (const shared::Light& light : device_lights(lights, max_layers)) found.push_back(light.shadow_layer);
    return found;
  };
  constexpr std::uint32_t kNone = shared::kNoShadow;
  EXPECT_EQ(layers(18), (std::vector<std::uint32_t>{0, 0, 6, kNone, 12}));
  EXPECT_EQ(layers(17), (std::vector<std::uint32_t>{0, 0, 6, kNone, kNone}));
  EXPECT_EQ(layers(0), (std::vector<std::uint32_t>{kNone, 0, kNone, kNone, kNone}));
}

}  // namespace
}  // namespace brume::planning
