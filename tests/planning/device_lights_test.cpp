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

}  // namespace
}  // namespace brume::planning
