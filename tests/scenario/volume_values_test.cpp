#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>

#include "grids/files/grid_files.hpp"
#include "scenario/scenario.hpp"
#include "scenario/volume_view.hpp"
#include "tests/log_lines.hpp"
#include "tests/scenario/volume_folder.hpp"
#include "volumes/volume_extent.hpp"
#include "volumes/volumes.hpp"

namespace brume::scenario {
namespace {

class VolumeValuesTest : public VolumeFolder {};

TEST_F(VolumeValuesTest, ValuesBelowZeroAreKeptForACurveThatDrawsThem) {
  grids::Grid grid = cube("pressure", -0.5f);
  const float high = 1;
  std::memcpy(grid.values.data(), &high, sizeof high);
  scene::VolumeOptions options{save("a.brv", {grid})};
  const auto frame = [&] { return volumes::load_volume_frame(options.file, options).value_or_throw(); };
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
  EXPECT_EQ(volumes::range_of(options, *frame()), glm::vec2(-1, 1));
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
  const auto frame = volumes::load_volume_frame(options.file, options).value_or_throw();
  ASSERT_TRUE(frame->heat);
  EXPECT_LE(frame->bounds.low.y, 0);
  EXPECT_GE(frame->bounds.high.y, 8.5f + 2 * 7.5f);
  EXPECT_GE(frame->bounds.high.x, 0.5f + 2 * 7.5f);
}

TEST_F(VolumeValuesTest, WhatIsTooColdDoesNotGlow) {
  const auto note_of = [&](float value, const std::string& name) {
    scene::VolumeOptions options{save("a.brv", {cube("density", 1), cube("temperature", value)})};
    options.heat = name;
    const auto frame = volumes::load_volume_frame(options.file, options).value_or_throw();
    EXPECT_EQ(frame->heat.has_value(), frame->heat_note.find("does not") == std::string::npos);
    return frame->heat_note;
  };
  EXPECT_EQ(note_of(333, ""), "\"temperature\" does not glow: as kelvin, none of its values is above 600");
  EXPECT_EQ(note_of(1200, ""), "\"temperature\" glows: its values are kelvin");
  EXPECT_EQ(note_of(333, "temperature"), "\"temperature\" glows: its values are kelvin");
}

/// Exposure of the first picture of a sequence.
float exposure_of(const std::filesystem::path& file, bool measured) {
  std::vector<scene::VolumeOptions> options(1);
  options[0].file = file;
  const auto volumes = volumes::Volumes::load(options).value_or_throw();
  if (measured) volumes->measure_sequence(0);
  return prepare_volume_view(file, volumes->typical_frame(0), volumes->extent(0), {}).exposure;
}

// The picture darkens by as much as a fire outshines white; by a stop for twice the radiance.
TEST_F(VolumeValuesTest, FiresAreExposedForThemselves) {
  const auto of = [&](float kelvin, float density) {
    return exposure_of(save("a.brv", {cube("density", density), cube("temperature", kelvin)}), false);
  };
  // Thin: what it emits grows with the fourth power; opaque: it is that over what absorbs.
  EXPECT_NEAR(of(7600, 1) - of(3800, 1), -4, 0.01f);
  EXPECT_NEAR(of(3800, 1) - of(1900, 1), -4, 0.01f);
  EXPECT_LT(of(1900, 1), 0);
  EXPECT_EQ(of(650, 1), 0) << "dark red does not outshine daylight";
  // What is red counts as the first power.
  EXPECT_NEAR(of(1900, 1) - of(1500, 1), -std::log2(1900.0f / 1500), 0.01f);
}

// Whichever frame is the hottest, and whichever is shown first or is the deepest.
TEST_F(VolumeValuesTest, AllFramesOfASequenceDecideItsExposure) {
  const auto frame = [&](float density, float kelvin) {
    return std::vector{cube("density", density), cube("temperature", kelvin)};
  };
  save("a_1.brv", frame(1, 1000));
  save("a_2.brv", frame(1, 3000));
  save("b_1.brv", frame(1, 3000));
  save("b_2.brv", frame(1, 1000));
  save("c_1.brv", frame(1, 3000));
  const float alone = exposure_of(folder_ / "c_1.brv", true);
  EXPECT_FLOAT_EQ(exposure_of(folder_ / "a_%d.brv", true), alone);
  EXPECT_FLOAT_EQ(exposure_of(folder_ / "b_%d.brv", true), alone);
}

// A frame whose heat is below 100 is one of kelvin beside others that are.
TEST_F(VolumeValuesTest, AllFramesOfASequenceDecideWhetherItIsInKelvin) {
  const auto frame = [&](float kelvin) {
    return std::vector{cube("density", 1), cube("flame", 1), cube("temperature", kelvin)};
  };
  save("a_1.brv", frame(80));
  save("a_2.brv", frame(1500));
  std::vector<scene::VolumeOptions> options(1);
  options[0].file = folder_ / "a_%d.brv";
  options[0].frame_rate = 1;
  const auto volumes = volumes::Volumes::load(options).value_or_throw();
  volumes->measure_sequence(0);
  for (const double seconds : {0.0, 1.0, 0.0}) {
    const auto shown = volumes->at(options, seconds)[0].frame;
    EXPECT_TRUE(shown->heat_is_kelvin) << seconds;
    EXPECT_EQ(shown->heat.has_value(), seconds > 0) << "80 K is dark";
  }
  EXPECT_EQ(volumes->extent(0).glow.size(), 1u);
}

TEST_F(VolumeValuesTest, OfGridsOfOneNameTheNumberChooses) {
  scene::VolumeOptions options{save("a.brv", {cube("fuel", 9), cube("density", 1), cube("density", 2)})};
  const auto frame = [&] { return volumes::load_volume_frame(options.file, options).value_or_throw(); };
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
  EXPECT_NE(
      volumes::load_volume_frame(options.file, options).failure().message.find("has no grid \"density[2]\""),
      std::string::npos);
  // What is called so is meant.
  options.density = "density[1]";
  options.file = save("b.brv", {cube("density", 1), cube("density", 2), cube("density[1]", 3)});
  EXPECT_EQ(frame()->density.high, 3);
  const auto shown = volumes::shown_grids(grids::load_grid_file(folder_ / "a.brv").value_or_throw());
  EXPECT_EQ(*shown, "\"density\"; " + note[0]);
}

TEST_F(VolumeValuesTest, TwoOfThreeChannelsAreNamed) {
  scene::VolumeOptions options{save("a.brv", {cube("density", 1), cube("color_r", 1), cube("color_b", 1)})};
  const std::string note =
      "the colour of \"color_r\", \"color_b\" is not drawn, as the file has no \"color_g\"";
  const auto frame = volumes::load_volume_frame(options.file, options).value_or_throw();
  EXPECT_FALSE(frame->colors);
  EXPECT_EQ(frame->grid_notes, std::vector{note});
  options.color = "color";
  EXPECT_NE(volumes::load_volume_frame(options.file, options).failure().message.find(note),
            std::string::npos);
  options.color = "none";
  EXPECT_TRUE(volumes::load_volume_frame(options.file, options).value_or_throw()->grid_notes.empty());
}

/// What is logged while a frame loads.
std::vector<std::string> said_of(const scene::VolumeOptions& options,
                                 std::shared_ptr<const volumes::VolumeFrame>& frame) {
  const LogLines log;
  frame = volumes::load_volume_frame(options.file, options).value_or_throw();
  return log.lines;
}

// Grids whose own indices lie far out, but whose transforms bring them together, give the same bricks.
TEST_F(VolumeValuesTest, FarIndicesAreExactInEveryGrid) {
  const glm::ivec3 far(100'000'000, 8, -80'000'000);
  const auto moved = [&](grids::Grid grid) {
    grid.bricks[0].origin += far;
    grid.world_from_index[3] -= glm::dvec4(glm::dvec3(far), 0);
    return grid;
  };
  grids::Grid colors = cube("Cd", 0.5f);
  colors.type = grids::ValueType::vec3f;
  colors.values.resize(grids::kBrickVoxels * sizeof(glm::vec3));
  const std::vector near{cube("density", 1), cube("temperature", 1500), colors};
  std::shared_ptr<const volumes::VolumeFrame> expected, frame;
  EXPECT_TRUE(said_of({save("a.brv", near)}, expected).empty());
  for (std::size_t grid = 0; grid < near.size(); ++grid) {
    std::vector some = near;
    some[grid] = moved(near[grid]);
    EXPECT_TRUE(said_of({save("b.brv", some)}, frame).empty());
    EXPECT_EQ(frame->density.level, 0);
    ASSERT_TRUE(frame->heat && frame->colors);
    // Where heat is in voxels of another transform is known to a voxel.
    EXPECT_TRUE(frame->bounds.contains(expected->bounds)) << grid;
    EXPECT_TRUE(
        (Box<float>{expected->bounds.low - 1.0f, expected->bounds.high + 1.0f}).contains(frame->bounds))
        << grid;
    // Counted from up to 4,096 voxels away: floats have 1/2048 there.
    const Box<float> seen = volumes::extent_of(*frame).seen, usual = volumes::extent_of(*expected).seen;
    EXPECT_LT(glm::distance(seen.low, usual.low) + glm::distance(seen.high, usual.high), 4e-3f) << grid;
    const auto place_of_ball = [](const volumes::VolumeFrame& of) {
      return glm::dvec3(of.heat->world_from_voxel * glm::dvec4(of.glow.at(0).middle, 1));
    };
    // Doubles of 1e8 have 1e-8.
    EXPECT_LT(glm::distance(place_of_ball(*frame), place_of_ball(*expected)), 1e-6) << grid;
    const auto texels = [](const volumes::VolumeFrame& of) {
      const glm::ivec3 brick(
          glm::floor(glm::dvec3(glm::inverse(of.density.world_from_voxel) * glm::dvec4(3, 3, 3, 1)) / 8.0));
      const auto all = of.colors->texels<std::uint64_t>(volume::ChannelId{0}, of.colors->slot_at(brick));
      return std::vector(all.begin(), all.end());
    };
    EXPECT_EQ(texels(*frame), texels(*expected)) << grid;
  }
}

// What really lies far away is not drawn, and does not blur the rest.
TEST_F(VolumeValuesTest, FarGridsAreRefusedWithALine) {
  const auto moved = [&](grids::Grid grid) {
    grid.bricks[0].origin = {100'000'000, 8, -80'000'000};
    return grid;
  };
  std::shared_ptr<const volumes::VolumeFrame> frame, alone;
  said_of({save("alone.brv", {cube("density", 1)})}, alone);
  EXPECT_TRUE(
      said_of({save("a.brv", {cube("density", 1), moved(cube("temperature", 1500))})}, frame).empty());
  EXPECT_EQ(frame->heat_note,
            "\"temperature\" does not glow: it lies too far from \"density\" to be drawn with it");
  EXPECT_FALSE(frame->heat);
  EXPECT_TRUE(frame->glow.empty());
  EXPECT_EQ(frame->density.level, 0);
  EXPECT_EQ(frame->bounds, alone->bounds);
  EXPECT_EQ(volumes::extent_of(*frame).seen, volumes::extent_of(*alone).seen);
  // Some of it here and some there: what is here is drawn.
  grids::Grid both = cube("temperature", 1500);
  both.bricks.insert(both.bricks.begin(), moved(both).bricks[0]);
  const std::vector<std::byte> values = both.values;
  both.values.insert(both.values.end(), values.begin(), values.end());
  const auto heat = said_of({save("c.brv", {cube("density", 1), both})}, frame);
  EXPECT_EQ(std::ranges::count_if(heat,
                                  [](const std::string& line) {
                                    return line.find("\"temperature\" is drawn only where \"density\" is") !=
                                           std::string::npos;
                                  }),
            1);
  EXPECT_EQ(frame->density.level, 0);
  EXPECT_TRUE(frame->heat);
  EXPECT_EQ(frame->bounds, alone->bounds);
  grids::Grid colors = moved(cube("Cd", 0.5f));
  colors.type = grids::ValueType::vec3f;
  colors.values.resize(grids::kBrickVoxels * sizeof(glm::vec3));
  const auto color = said_of({save("b.brv", {cube("density", 1), colors})}, frame);
  ASSERT_EQ(color.size(), 1u);
  EXPECT_NE(color[0].find("\"Cd\" colours nothing"), std::string::npos) << color[0];
}

// A voxel a hundred times as far away as a cloud is wide: the same place, size and light as without it.
TEST_F(VolumeValuesTest, AStrayVoxelChangesNoFirstPicture) {
  const auto view_of = [&](const std::vector<grids::Grid>& grids, std::vector<std::string>& said) {
    const LogLines log;
    const auto scenario = load_scenario(save("a.brv", grids), {}, {}).value_or_throw();
    said = log.lines;
    return std::pair(scenario.timeline.volumes[0], scenario.camera);
  };
  grids::Grid cloud = cube("density", 1);
  for (int i = 1; i < 8; ++i) {
    cloud.bricks.push_back(cloud.bricks[0]);
    cloud.bricks.back().origin.x = 8 * i;
  }
  const std::vector<std::byte> values = cloud.values;
  for (int i = 1; i < 8; ++i) cloud.values.insert(cloud.values.end(), values.begin(), values.end());
  std::vector<std::string> said;
  const auto [alone, camera] = view_of({cloud}, said);
  EXPECT_TRUE(said.empty());
  for (const float value : {1e-3f, 1.0f}) {
    grids::Grid strays = cloud;
    strays.bricks.push_back({{0, 0, 8000}, {1}});
    strays.values.resize(strays.values.size() + values.size());
    std::memcpy(strays.values.data() + cloud.values.size(), &value, sizeof value);
    const auto [volume, view] = view_of({strays}, said);
    EXPECT_EQ(volume.position_world, alone.position_world);
    EXPECT_EQ(volume.scale, alone.scale);
    EXPECT_FLOAT_EQ(volume.extinction, alone.extinction);
    // Places near 1,000 m are rounded to 1e-4.
    EXPECT_LT(glm::distance(view.position_world, camera.position_world), 1e-3f);
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("0.024 % of its voxels lie far from the rest"), std::string::npos) << said[0];
    EXPECT_NE(volumes::shown_grids({{strays}, {}})->find(said[0].substr(said[0].find("0.024"))),
              std::string::npos);
  }
}

// As Mantaflow saves them, of which Blender's are multiplied by the density.
TEST_F(VolumeValuesTest, ThreeGridsOfChannelsAreColours) {
  const auto color_of = [&](std::vector<grids::Grid> grids, const std::string& name) {
    std::vector<scene::VolumeOptions> options(1);
    options[0].file = save("a.brv", std::move(grids));
    options[0].color = name;
    const auto volumes = volumes::Volumes::load(options).value_or_throw();
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
