// Fixture of the tests of the Blender add-on.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <set>

#include "image/image.hpp"
#include "tests/blender/blender_run.hpp"

namespace brume::blender {

/// Runs Blender once for all cases; skips them if Blender is not installed.
class Blender : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const BlenderRun& run = blender_run();
    if (!run.blender_is_there) GTEST_SKIP() << "blender is not installed; script/bootstrap test installs it";
    ASSERT_EQ(run.exit_code, 0) << run.log;
  }
  static std::filesystem::path level(const std::string& name, const std::string& kind) {
    return blender_run().folder / name / kind / (kind == "txt" ? "level.txt" : "level.glb");
  }
  static std::filesystem::path timeline(const std::string& name, const std::string& kind) {
    return blender_run().folder / name / kind / "level.toml";
  }
};

/// Fails for a nearly blank image: expects lit smoke and bricks in front of a night sky.
inline void expect_a_picture(const image::Image8& picture) {
  std::set<std::uint32_t> colors;
  double sum = 0, squares = 0;
  const std::size_t count = picture.rgba.size() / 4;
  for (std::size_t i = 0; i < count; ++i) {
    const auto* p = &picture.rgba[4 * i];
    colors.insert(static_cast<std::uint32_t>(p[0] << 16 | p[1] << 8 | p[2]));
    sum += p[1];
    squares += p[1] * p[1];
  }
  const double mean = sum / static_cast<double>(count);
  const double deviation = std::sqrt(squares / static_cast<double>(count) - mean * mean);
  EXPECT_GT(colors.size(), 2000u);
  EXPECT_GT(mean, 20);
  EXPECT_LT(mean, 200);
  EXPECT_GT(deviation, 20);
}

}  // namespace brume::blender
