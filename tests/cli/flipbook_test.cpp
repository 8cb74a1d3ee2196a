// `brume render --flipbook`: frames as the tiles of sheets.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "image/flipbook.hpp"
#include "tests/cli/command_test.hpp"

namespace brume::cli {
namespace {
using image::LightSide;
using image::Texels;

constexpr const char* kCamera = "0.4,0.4,3 0.4,0.4,0.4 30";

class Flipbook : public CommandTest {
 protected:
  void bake(const std::string& name, const std::string& seed) const {
    run_well({"bake", "pyroclastic", "--edge", "16", "--seed", seed, "-o", name});
  }
  Texels exr(const std::string& name) const { return image::to_texels(CommandTest::exr(name)); }
  Json json(const std::string& name) const { return Json::parse(bytes(name)); }
};

TEST_F(Flipbook, TilesAreTheFramesWithoutTheirBackground) {
  bake("a_1.brv", "1");
  bake("a_2.brv", "2");
  bake("a_3.brv", "3");
  run_well(
      {"render", "a_%d.brv", "-o", "sheet.exr", "--flipbook", "2x2", "--size", "24x20", "--camera", kCamera});
  run_well({"render", "a_%d.brv", "-o", "f_%d.exr", "--background", "none", "--size", "20x16", "--camera",
            kCamera});
  const Texels sheet = exr("sheet.exr");
  EXPECT_EQ(glm::uvec2(sheet.width, sheet.height), glm::uvec2(48, 40));
  const image::FlipbookLayout layout{2, 2, {24, 20}, 2};
  const Json description = json("sheet.json");
  EXPECT_EQ(description["frames"], (Json{0, 1, 1, 2}));
  EXPECT_EQ(description["alpha"], "premultiplied");
  EXPECT_EQ(description["tile"], (Json{24, 20}));
  for (std::uint32_t tile = 0; tile < 4; ++tile) {
    const std::string frame = std::to_string(description["frames"][tile].get<int>());
    EXPECT_EQ(image::tile_of(layout, tile, sheet).rgba,
              image::with_gutter(exr("f_" + frame + ".exr"), 2).rgba)
        << tile;
  }
}

TEST_F(Flipbook, TheCameraFitsWhatIsSeen) {
  bake("a_1.brv", "1");
  bake("a_2.brv", "2");
  run_well({"render", "a_%d.brv", "-o", "sheet.png", "--flipbook", "2x1", "--size", "48x48"});
  const image::Image8 sheet = png("sheet.png");
  int left = 96, right = 0, top = 48, bottom = 0;
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 96; ++x) {
      if (sheet.rgba[4 * static_cast<std::size_t>(x + 96 * y) + 3] < 2) continue;
      left = std::min(left, x % 48);
      right = std::max(right, x % 48);
      top = std::min(top, y);
      bottom = std::max(bottom, y);
    }
  }
  // Nine tenths of the 44 texels within the gutter, along the longer side; in the middle of both.
  EXPECT_NEAR(std::max(right - left, bottom - top) + 1, 0.9 * 44, 3);
  EXPECT_NEAR(0.5 * (left + right + 1), 24, 2);
  EXPECT_NEAR(0.5 * (top + bottom + 1), 24, 2);
}

// Under light along an axis, a sheet is the picture that is rendered with it.
TEST_F(Flipbook, LightOfASideIsThatOfASunThere) {
  bake("a.brv", "1");
  folder_.write("far.obj", "v -9 -9 -9\nv -9.1 -9 -9\nv -9 -9.1 -9\nf 1 2 3\n");
  const auto timeline = [&](const std::string& name, int azimuth) {
    folder_.write(name,
                  "version = 1\nscene = \"far.obj\"\n[sky]\nzenith = [0, 0, 0]\nhorizon = [0, 0, 0]\n"
                  "ambient = [0, 0, 0]\nbounce = 0\n[sun]\nazimuth = " +
                      std::to_string(azimuth) +
                      "\nelevation = 0.1\nirradiance = [100, 100, 100]\n"
                      "[[volume]]\nfile = \"a.brv\"\nextinction = 8\nalbedo = [0.9, 0.9, 0.9]\n");
  };
  timeline("all.toml", 45);
  run_well({"render", "all.toml", "-o", "s.exr", "--flipbook", "1x1", "--size", "32x32", "--flipbook-gutter",
            "0", "--flipbook-maps", "six-way,normals", "--camera", kCamera});
  const Texels positive = exr("s_right_top_back.exr"), negative = exr("s_left_bottom_front.exr");
  // The camera looks along -z.
  const std::array<std::pair<int, std::pair<const Texels*, int>>, 3> suns{
      {{90, {&positive, 0}}, {-90, {&negative, 0}}, {0, {&negative, 2}}}};
  for (const auto& [azimuth, map] : suns) {
    timeline("one.toml", azimuth);
    run_well({"render", "one.toml", "-o", "one.exr", "--background", "none", "--size", "32x32", "--camera",
              kCamera});
    const Texels one = exr("one.exr");
    double of_map = 0, of_sun = 0;
    for (std::size_t i = 0; i < one.rgba.size(); ++i) {
      of_map += double{map.first->rgba[i][map.second]};
      of_sun += std::numbers::pi / 100 * double{one.rgba[i].g};
    }
    // The sun stands a tenth of a degree above the horizon; halves have 11 bits.
    EXPECT_GT(of_sun, 1);
    EXPECT_NEAR(of_map / of_sun, 1, 0.005) << azimuth;
  }
  EXPECT_EQ(json("s.json")["six_way_scale"]["light"], 1);
  for (const glm::vec4& normal : exr("s_normals.exr").rgba)
    EXPECT_NEAR(glm::length(glm::vec3(normal)), 1, 1e-5);
}

TEST_F(Flipbook, MotionOfAnEngineHasItsDirections) {
  bake("a_1.brv", "1");
  bake("a_2.brv", "2");
  const Arguments base{"render", "a_%d.brv",        "--flipbook", "2x1",      "--size",
                       "24x24",  "--flipbook-maps", "motion",     "--camera", kCamera};
  run_well(base, {"-o", "down.png", "--flipbook-preset", "godot"});
  run_well(base, {"-o", "up.png", "--flipbook-preset", "unity"});
  const image::Image8 down = png("down_motion.png"), up = png("up_motion.png");
  bool moves = false;
  for (std::size_t i = 0; i < down.rgba.size(); i += 4) {
    EXPECT_EQ(down.rgba[i], up.rgba[i]);
    // Around 128, up to the rounding of each.
    EXPECT_NEAR(down.rgba[i + 1] + up.rgba[i + 1], 256, 1);
    moves = moves || down.rgba[i + 1] != 128;
    // The last tile moves nowhere.
    if (i / 4 % 48 >= 24) {
      EXPECT_EQ(down.rgba[i], 128);
    }
  }
  EXPECT_TRUE(moves);
  EXPECT_GT(json("up.json")["motion_scale"].get<double>(), 0);
}

TEST_F(Flipbook, WhatCannotBeIsSaidBeforeAnythingIsDrawn) {
  bake("a.brv", "1");
  const auto says = [&](const Arguments& more, const std::string& text) {
    expect_failure(folder_, joined({"render", "a.brv"}, more), 2, {text});
  };
  says({"-o", "s.png", "--flipbook", "8"}, "--flipbook '8': expected columns and rows, such as 8x8");
  says({"-o", "s.png", "--flipbook", "0x8"}, "expected columns and rows");
  says({"-o", "s.png", "--flipbook", "8x8x"}, "expected columns and rows");
  says({"-o", "s.mp4", "--flipbook", "8x8"}, "a flipbook is one image");
  says({"-o", "s_%04d.png", "--flipbook", "8x8"}, "a flipbook is one image");
  says({"-o", "s.png", "--flipbook", "99x9"}, "at most 16384");
  says({"-o", "s.png", "--flipbook", "2x2", "--size", "4x4"}, "--flipbook-gutter 2: leaves nothing");
  says({"-o", "s.png", "--flipbook", "2x2", "--flipbook-maps", "six-way,glow"},
       "expected six-way, normals, emission");
  says({"-o", "s.png", "--flipbook-gutter", "1"}, "--flipbook-gutter requires --flipbook");
  says({"-o", "s.png", "--flipbook", "2x2", "--time", "1"}, "--time is not for --flipbook");
  says({"-o", "s.png", "--flipbook", "2x2", "--orbit", "360", "--flipbook-maps", "normals"},
       "--orbit turns the camera");
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "s.json"));
}

TEST_F(Flipbook, AlikeTilesAreNamed) {
  bake("a.brv", "1");
  const Arguments still{"render", "a.brv",  "-o",    "s.png",    "--flipbook",
                        "2x1",    "--size", "20x20", "--camera", kCamera};
  EXPECT_NE(run(still).error.find("all tiles are alike"), std::string::npos);
  EXPECT_EQ(run(still, {"--orbit", "360"}).error.find("all tiles are alike"), std::string::npos);
}

}  // namespace
}  // namespace brume::cli
