// Transfer functions: curves, colour maps, and what timelines say of them.
#include "scene/transfer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/color_space.hpp>
#include <random>

#include "scene/files/timeline_reader.hpp"
#include "scene/timeline.hpp"
#include "tests/scene/scene_test_tools.hpp"

namespace brume::scene {
namespace {

using Curve = std::vector<OpacityPoint>;

TEST(OpacityCurve, IsLinearBetweenItsPointsAndConstantBeyond) {
  const Curve curve{{0.25f, 0.5f}, {0.5f, 1}, {0.5f, 0.25f}, {0.75f, 0}};
  for (const auto& [at, opacity] : {std::pair(0.0, 0.5),
                                    {0.25, 0.5},
                                    {0.375, 0.75},
                                    {0.5, 0.25},
                                    {0.625, 0.125},
                                    {0.75, 0.0},
                                    {1.0, 0.0}})
    EXPECT_EQ(opacity_at(curve, at), opacity) << at;
}

TEST(OpacityCurve, TheIntegralIsThatOfTheCurve) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> draw(0, 1);
  for (int round = 0; round < 50; ++round) {
    Curve curve(2 + random() % 6);
    for (OpacityPoint& point : curve) point = {draw(random), draw(random)};
    if (round % 3 == 0) curve[1].at = curve[0].at;  // a step
    std::ranges::stable_sort(curve, {}, &OpacityPoint::at);
    constexpr int kSteps = 20000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      if (i % 1000 == 0) {
        // The midpoint rule is exact but in the cells of points: each is off by a cell of an opacity of 1 at
        // most.
        EXPECT_NEAR(opacity_integral(curve, double(i) / kSteps), sum,
                    static_cast<double>(curve.size()) / kSteps);
      }
      sum += opacity_at(curve, (i + 0.5) / kSteps) / kSteps;
    }
  }
}

glm::ivec3 bytes_of(const ColorMap& map, double at) {
  return glm::ivec3(glm::round(glm::convertLinearToSRGB(color_at(map, at)) * 255.0));
}

TEST(ColorMap, NamedOnesHaveThePublishedColours) {
  // Moreland 2009, table of the map from (59, 76, 192) to (180, 4, 38); its middle is (221, 221, 221).
  EXPECT_EQ(bytes_of({"cool-warm", {}}, 0), glm::ivec3(59, 76, 192));
  EXPECT_EQ(bytes_of({"cool-warm", {}}, 0.5), glm::ivec3(221, 221, 221));
  EXPECT_EQ(bytes_of({"cool-warm", {}}, 1), glm::ivec3(180, 4, 38));
  // Entry 128 of matplotlib's viridis and inferno, whose coarse tables are at most 7 off.
  EXPECT_EQ(bytes_of({"viridis", {}}, 0), glm::ivec3(0x44, 0x01, 0x54));
  EXPECT_LE(glm::length(glm::vec3(bytes_of({"viridis", {}}, 0.5) - glm::ivec3(33, 145, 140))), 12);
  EXPECT_LE(glm::length(glm::vec3(bytes_of({"inferno", {}}, 0.5) - glm::ivec3(188, 55, 84))), 12);
  EXPECT_EQ(bytes_of({"grey", {}}, 0.2), glm::ivec3(51));
  EXPECT_EQ(bytes_of({"cubehelix", {}}, 0), glm::ivec3(0));
  EXPECT_EQ(bytes_of({"cubehelix", {}}, 1), glm::ivec3(255));
}

TEST(ColorMap, SequentialOnesGrowBrighter) {
  for (const std::string_view name : color_map_names()) {
    const ColorMap map{std::string(name), {}};
    ASSERT_FALSE(fault_of(map)) << name;
    double before = -1;
    for (int i = 0; i <= 100; ++i) {
      const glm::dvec3 color = color_at(map, i / 100.0);
      EXPECT_GE(std::min({color.r, color.g, color.b}), 0) << name << i;
      EXPECT_LE(std::max({color.r, color.g, color.b}), 1) << name << i;
      const double luminance = glm::dot(color, glm::dvec3(0.2126, 0.7152, 0.0722));
      EXPECT_TRUE(name == "cool-warm" || luminance > before) << name << " " << i;
      before = luminance;
    }
  }
}

constexpr const char* kHead = "version = 1\nscene = \"a.brv\"\n[[volume]]\nfile = \"a.brv\"\n";

std::string error_of(const std::string& text) {
  const auto timeline = parse_timeline(kHead + text, "t.toml");
  if (timeline) return "no error";
  EXPECT_EQ(timeline.failure().code, ErrorCode::bad_input);
  return timeline.failure().message;
}

TEST(TransferFunction, IsReadFromTheTimeline) {
  const auto timeline = parse_timeline(std::string(kHead) + R"(color = "Cd"
range = [10, 20.5]
opacity = [[0, 0], [0.5, 0.25], [0.5, 1]]
color_map = [[0.0, 1.0, 0.0, 0.0], [1.0, 0.0, 0.5, 1.0]]
glow = 0.75
)",
                                       "t.toml")
                            .value_or_throw();
  const VolumeOptions& volume = timeline.volumes.at(0);
  EXPECT_EQ(volume.color, "Cd");
  EXPECT_EQ(volume.range, glm::vec2(10, 20.5f));
  EXPECT_EQ(volume.opacity, (Curve{{0, 0}, {0.5f, 0.25f}, {0.5f, 1}}));
  EXPECT_EQ(volume.color_map.points[1], (ColorPoint{1, {0, 0.5f, 1}}));
  EXPECT_EQ(volume.glow, 0.75f);
  EXPECT_EQ(
      parse_timeline(std::string(kHead) + "color_map = \"magma\"\n", "t.toml")->volumes[0].color_map.name,
      "magma");
}

TEST(TransferFunction, FaultsNameThePlaceAndTheRemedy) {
  std::string many = "opacity = [";
  for (int i = 0; i < 65; ++i) many += "[0.5, 0.5], ";
  const std::string colours = "like [[0.0, 0.2, 0.3, 0.8], [1.0, 0.7, 0.0, 0.1]]";
  expect_mistakes(
      error_of, "t.toml",
      {{"opacity = [[0, 0]]", "5:11", {"\"opacity\": expected 2 to 64 points", "found 1"}},
       {"opacity = []", "5:11", {"\"opacity\": expected 2 to 64 points", "found 0"}},
       {many + "]", "5:11", {"\"opacity\": expected 2 to 64 points", "found 65"}},
       {"opacity = [[0.5, 0], [0.25, 1]]", "5:22", {"point 2", "from 0.5 on", "0.25; sort the points"}},
       {"opacity = [[0, 0], [1, nan]]", "5:24", {"\"opacity\": expected a number from", "nan"}},
       {"opacity = [[0, 0], [1, 1.5]]", "5:24", {"\"opacity\": expected a number from", "1.5"}},
       {"opacity = [[0, 0, 0], [1, 1]]", "5:12", {"points of 2 numbers, like [[0.0, 0.0], [1.0, 1.0]]"}},
       {"opacity = 1", "5:11", {"\"opacity\": expected points of 2 numbers"}},
       {"color_map = [[0, 1], [1, 1]]", "5:14", {"\"color_map\"", "points of 4 numbers", colours}},
       {"color_map = \"virdis\"", "5:13", {"no colour map \"virdis\"", "\"viridis\"?"}},
       {"color_map = \"\"", "5:13", {"\"color_map\": expected a name or points"}},
       {"range = [1, 1]", "5:9", {"\"range\": expected the lower value first", "found [1, 1]"}},
       {"range = [0]", "5:9", {"\"range\": expected two numbers"}},
       {"range = [0, inf]", "5:13", {"\"range\": expected a number from", "found inf"}},
       {"glow = 2", "5:8", {"\"glow\": expected a number from", "found 2"}}});
}

}  // namespace
}  // namespace brume::scene
