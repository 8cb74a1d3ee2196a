#include <gtest/gtest.h>

#include <cstring>
#include <glm/gtc/packing.hpp>

#include "grids/files.hpp"
#include "scenario/volume_view.hpp"
#include "scenario/volumes.hpp"
#include "tests/scenario/volume_folder.hpp"

namespace brume::scenario {
namespace {

class VolumeValuesTest : public VolumeFolder {};

TEST_F(VolumeValuesTest, ValuesBelowZeroAreKeptForACurveThatDrawsThem) {
  grids::Grid grid = cube("pressure", -0.5f);
  const float high = 1;
  std::memcpy(grid.values.data(), &high, sizeof high);
  scene::VolumeOptions options{save("a.brv", {grid})};
  const auto frame = [&] { return load_volume_frame(options.file, options).value_or_throw(); };
  const std::string note =
      "\"pressure\" has values below 0, down to -0.5, which count as 0: a range from below 0 with an opacity "
      "curve "
      "draws them";
  EXPECT_EQ(frame()->value_note, note);
  EXPECT_EQ(frame()->density.low, 0);
  options.range = glm::vec2(-1, 1);
  EXPECT_EQ(frame()->value_note, note);
  options.opacity = {{0, 0}, {0.5f, 0}, {1, 1}};
  EXPECT_EQ(frame()->value_note, "") << "the curve draws nothing there";
  EXPECT_EQ(frame()->density.low, 0);
  options.opacity = {{0, 1}, {0.5f, 0}, {1, 1}};
  EXPECT_EQ(frame()->value_note, "");
  EXPECT_NEAR(frame()->density.low, -0.5f, 1e-3f);
  EXPECT_NEAR(frame()->density.high, 1, 1e-3f);
  EXPECT_EQ(range_of(options, *frame()), glm::vec2(-1, 1));
  // Rounding of a simulation is no value below 0.
  options.opacity.clear();
  const float tiny = -0.005f;
  for (std::size_t i = sizeof high; i < grid.values.size(); i += sizeof tiny)
    std::memcpy(&grid.values[i], &tiny, sizeof tiny);
  options.file = save("b.brv", {grid});
  EXPECT_EQ(frame()->value_note, "");
}

// Voxels twice as large, a metre above the density: what glows there is drawn as if they were alike.
TEST_F(VolumeValuesTest, HeatReachesBeyondTheDensityWhateverItsVoxels) {
  grids::Grid heat = cube("temperature", 1500);
  heat.world_from_index = glm::dmat4(2);
  heat.world_from_index[3] = {0.5, 8.5, 0.5, 1};
  scene::VolumeOptions options{save("a.brv", {cube("density", 1), heat})};
  const auto frame = load_volume_frame(options.file, options).value_or_throw();
  ASSERT_TRUE(frame->heat);
  EXPECT_LE(frame->bounds.low.y, 0);
  EXPECT_GE(frame->bounds.high.y, 8.5f + 2 * 7.5f);
  EXPECT_GE(frame->bounds.high.x, 0.5f + 2 * 7.5f);
}

TEST_F(VolumeValuesTest, WhatIsTooColdDoesNotGlow) {
  const auto note_of = [&](float value, const std::string& name) {
    scene::VolumeOptions options{save("a.brv", {cube("density", 1), cube("temperature", value)})};
    options.heat = name;
    const auto frame = load_volume_frame(options.file, options).value_or_throw();
    EXPECT_EQ(frame->heat.has_value(), frame->heat_note.find("does not") == std::string::npos);
    return frame->heat_note;
  };
  EXPECT_EQ(note_of(333, ""), "\"temperature\" does not glow: as kelvin, none of its values is above 600");
  EXPECT_EQ(note_of(1200, ""), "\"temperature\" glows: its values are kelvin");
  EXPECT_EQ(note_of(333, "temperature"), "\"temperature\" glows: its values are kelvin");
}

// Fires of 1,900 K and below are as bright as the day beside them; a hotter one darkens the picture as much
// as it outshines that.
TEST_F(VolumeValuesTest, HotFiresAreExposedForThemselves) {
  const auto exposure_of = [&](float kelvin) {
    std::vector<scene::VolumeOptions> options(1);
    options[0].file = save("a.brv", {cube("density", 1), cube("temperature", kelvin)});
    const auto volumes = Volumes::load(options).value_or_throw();
    return prepare_volume_view(options[0].file, volumes->typical_frame(0), volumes->extent(0), {}).exposure;
  };
  EXPECT_EQ(exposure_of(1200), 0);
  EXPECT_EQ(exposure_of(1900), 0);
  EXPECT_NEAR(exposure_of(3800), -4, 0.01f);
}

TEST_F(VolumeValuesTest, OfGridsOfOneNameTheNumberChooses) {
  scene::VolumeOptions options{save("a.brv", {cube("fuel", 9), cube("density", 1), cube("density", 2)})};
  const auto frame = [&] { return load_volume_frame(options.file, options).value_or_throw(); };
  const std::vector<std::string> note{
      "2 grids are called \"density\": \"density\" is drawn; name another, such as \"density[1]\", to see "
      "it"};
  EXPECT_EQ(frame()->density.high, 1);
  EXPECT_EQ(frame()->grid_notes, note);
  EXPECT_EQ(frame()->number_grids, (std::vector<std::string>{"fuel", "density", "density[1]"}));
  for (const auto& [name, value] : {std::pair("density[0]", 1.0f), {"density[1]", 2.0f}, {"fuel[0]", 9.0f}}) {
    options.density = name;
    EXPECT_EQ(frame()->density.high, value) << name;
    EXPECT_TRUE(frame()->grid_notes.empty()) << name;
  }
  options.density = "density[2]";
  EXPECT_NE(load_volume_frame(options.file, options).failure().message.find("has no grid \"density[2]\""),
            std::string::npos);
  // What is called so is meant.
  options.density = "density[1]";
  options.file = save("b.brv", {cube("density", 1), cube("density", 2), cube("density[1]", 3)});
  EXPECT_EQ(frame()->density.high, 3);
  const auto shown = shown_grids(grids::load_grid_file(folder_ / "a.brv").value_or_throw());
  EXPECT_EQ(*shown, "\"density\"; " + note[0]);
}

TEST_F(VolumeValuesTest, TwoOfThreeChannelsAreNamed) {
  scene::VolumeOptions options{save("a.brv", {cube("density", 1), cube("color_r", 1), cube("color_b", 1)})};
  const std::string note =
      "the colour of \"color_r\", \"color_b\" is not drawn, as the file has no \"color_g\"";
  const auto frame = load_volume_frame(options.file, options).value_or_throw();
  EXPECT_FALSE(frame->colors);
  EXPECT_EQ(frame->grid_notes, std::vector{note});
  options.color = "color";
  EXPECT_NE(load_volume_frame(options.file, options).failure().message.find(note), std::string::npos);
  options.color = "none";
  EXPECT_TRUE(load_volume_frame(options.file, options).value_or_throw()->grid_notes.empty());
}

// As Mantaflow saves them, of which Blender's are multiplied by the density.
TEST_F(VolumeValuesTest, ThreeGridsOfChannelsAreColours) {
  const auto color_of = [&](std::vector<grids::Grid> grids, const std::string& name) {
    std::vector<scene::VolumeOptions> options(1);
    options[0].file = save("a.brv", std::move(grids));
    options[0].color = name;
    const auto volumes = Volumes::load(options).value_or_throw();
    const auto* const colors = volumes->typical_frame(0).colors.get();
    if (!colors) return glm::vec3(-1);
    const auto texels = colors->texels<std::uint64_t>(volume::ChannelId{0}, colors->slot_at({0, 0, 0}));
    return glm::vec3(glm::unpackHalf4x16(texels[4 + 10 * (4 + 10 * 4)]));
  };
  std::vector<grids::Grid> grids{cube("density", 0.5f), cube("color_r", 0.5f), cube("color_g", 0.25f),
                                 cube("color_b", 0)};
  EXPECT_EQ(color_of(grids, ""), glm::vec3(0.5f, 0.25f, 0));
  EXPECT_EQ(color_of(grids, "color"), glm::vec3(0.5f, 0.25f, 0));
  EXPECT_EQ(color_of(grids, "none"), glm::vec3(-1));
  grids[0].metadata.push_back({"file_base_resolution", "vec3i", std::vector<std::byte>(12)});
  EXPECT_EQ(color_of(grids, ""), glm::vec3(1, 0.5f, 0));
  grids.pop_back();
  EXPECT_EQ(color_of(grids, ""), glm::vec3(-1)) << "two channels are no colour";
  for (const char* part : {"dye_r", "dye_g", "dye_b"}) grids.push_back(cube(part, 0.25f));
  EXPECT_EQ(color_of(grids, "dye"), glm::vec3(0.5f));
}

}  // namespace
}  // namespace brume::scenario
