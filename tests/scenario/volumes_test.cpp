#include "volumes/volumes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>

#include "grids/files/grid_files.hpp"
#include "scenario/editable_scenario.hpp"
#include "scenario/scenario.hpp"
#include "tests/log_lines.hpp"
#include "tests/scenario/volume_folder.hpp"

namespace brume::scenario {
namespace {

class VolumesTest : public VolumeFolder {
 protected:
  /// Frames whose files have this pattern; each is full of its number plus `more`.
  void save_frames(const std::string& pattern, std::initializer_list<int> numbers, float more = 0) const {
    for (const int number : numbers) {
      std::string name = pattern;
      name.replace(name.find('#'), 1, std::to_string(number));
      save(name, {cube("density", static_cast<float>(number) + more)});
    }
  }
  /// The options of one volume of this file.
  std::vector<scene::VolumeOptions> options_of(const std::string& file, float frame_rate = 1) const {
    std::vector<scene::VolumeOptions> options(1);
    options[0].file = folder_ / file;
    options[0].frame_rate = frame_rate;
    return options;
  }
};

TEST_F(VolumesTest, ASequenceShowsTheFrameOfATime) {
  save_frames("f_000#.brv", {3, 4, 6});
  save("f_x.brv", {cube("density", 9)});
  auto options = options_of("f_%04d.brv", 10);
  options[0].start = 1;
  const auto volumes = volumes::Volumes::load(options).value_or_throw();
  EXPECT_EQ(volumes->files().size(), 3u);
  const auto shown = [&](double seconds) { return volumes->at(options, seconds)[0].frame->density.high; };
  for (const auto& [seconds, frame] :
       {std::pair(0.0, 3), {1.0, 3}, {1.099, 3}, {1.1, 4}, {1.2, 4}, {1.3, 6}, {99.0, 6}, {1.1, 4}})
    EXPECT_EQ(shown(seconds), static_cast<float>(frame)) << seconds;
  options[0].loop = true;
  for (const auto& [seconds, frame] : {std::pair(1.4, 3), {1.5, 4}, {0.9, 6}, {1.8, 3}})
    EXPECT_EQ(shown(seconds), static_cast<float>(frame)) << seconds;
}

TEST_F(VolumesTest, ASequenceEndsClippedOrPlaysToAndFro) {
  save_frames("f_#.brv", {3, 4, 5, 6, 9});
  auto options = options_of("f_%d.brv", 10);
  options[0].first = 4;
  options[0].last = 7;
  const auto volumes = volumes::Volumes::load(options).value_or_throw();
  EXPECT_EQ(volumes->files().size(), 3u);
  EXPECT_EQ(volumes->typical_frame(0).density.high, 4);
  const auto shown = [&](double seconds) {
    const auto frame = volumes->at(options, seconds)[0].frame;
    return frame ? frame->density.high : 0;
  };
  // 7 is missing.
  for (const auto& [seconds, frame] : {std::pair(-0.1, 4), {0.0, 4}, {0.2, 6}, {0.3, 6}, {0.4, 6}})
    EXPECT_EQ(shown(seconds), static_cast<float>(frame)) << seconds;
  options[0].clip = true;
  for (const auto& [seconds, frame] : {std::pair(-0.1, 0), {0.0, 4}, {0.3, 6}, {0.4, 0}, {9.0, 0}, {0.1, 5}})
    EXPECT_EQ(shown(seconds), static_cast<float>(frame)) << seconds;
  options[0].clip = false;
  options[0].ping_pong = true;
  for (const auto& [seconds, frame] :
       {std::pair(0.0, 4), {0.1, 5}, {0.3, 6}, {0.4, 6}, {0.5, 5}, {0.6, 4}, {0.7, 5}, {-0.1, 5}})
    EXPECT_EQ(shown(seconds), static_cast<float>(frame)) << seconds;
  options[0].last = 4;
  EXPECT_EQ(volumes::Volumes::load(options).value_or_throw()->at(options, 0.7)[0].frame->density.high, 4);
  options[0].first = options[0].last = 7;
  EXPECT_EQ(volumes::Volumes::load(options).failure().code, ErrorCode::bad_input);
}

// Simulations begin with nothing, and end far from where they began.
TEST_F(VolumesTest, TheTypicalFrameIsTheDeepestOfThoseWithAnything) {
  const auto cubes = [](float value, int count) {
    grids::Grid grid = cube("density", value);
    for (int i = 1; i < count; ++i) {
      const grids::Grid one = cube("density", value);
      grid.bricks.push_back(one.bricks[0]);
      grid.bricks.back().origin.x = 8 * i;
      grid.values.insert(grid.values.end(), one.values.begin(), one.values.end());
    }
    return grid;
  };
  save("f_0.brv", {cubes(0, 1)});
  save("f_1.brv", {cubes(2, 1)});
  save("f_2.brv", {cubes(3, 1)});
  save("f_3.brv", {cubes(0.5f, 6)});
  const auto options = options_of("f_#.brv");
  const auto volumes = volumes::Volumes::load(options).value_or_throw();
  EXPECT_EQ(volumes->typical_frame(0).density.high, 2) << "the first in which there is anything";
  EXPECT_EQ(volumes->at(options, 0)[0].frame->density.high, 0);
  volumes->measure_sequence(0);
  EXPECT_EQ(volumes->typical_frame(0).density.high, 3) << "few rays go along the six bricks of the last";
  const volumes::VolumeExtent extent = volumes->extent(0);
  EXPECT_DOUBLE_EQ(extent.depth, 24);
  // Index 0 is the middle of voxel 0, and filtering reaches nearly to the next one: to a hundredth.
  EXPECT_LT(glm::distance(extent.seen.low, glm::vec3(-0.99f)), 1e-5f);
  EXPECT_LT(glm::distance(extent.seen.high, glm::vec3(47.99f, 7.99f, 7.99f)), 1e-5f);
  EXPECT_EQ(volumes->at(options, 0)[0].frame->density.high, 0) << "what is shown is that of the time";
  EXPECT_EQ(volumes->at(options, 3)[0].frame->density.high, 0.5f);
}

// Starts and rates are float32, and written with fewer digits still.
TEST_F(VolumesTest, ARoundedStartShowsItsFrame) {
  save_frames("f_#.brv", {0, 1}, 1);
  auto options = options_of("f_%d.brv");
  options[0].clip = true;
  const auto volumes = volumes::Volumes::load(options).value_or_throw();
  for (const double rate : {24.0, 24000 / 1001.0, 60.0})
    for (int start = 0; start < 2000; start += 7) {
      options[0].frame_rate = static_cast<float>(rate);
      options[0].start = static_cast<float>(std::round(start / rate * 1e6) / 1e6);
      const auto shown = volumes->at(options, start / rate)[0].frame;
      ASSERT_TRUE(shown) << start;
      EXPECT_EQ(shown->density.high, 1) << start;
      EXPECT_FALSE(volumes->at(options, (start - 1) / rate)[0].frame) << start;
    }
}

// The next frame is read ahead; a viewer that does not wait ends at the same frames.
TEST_F(VolumesTest, WithoutWaitingItEndsAtTheSameFrame) {
  save_frames("f_#.brv", {1, 2, 3, 4});
  const auto options = options_of("f_%d.brv");
  const auto volumes = volumes::Volumes::load(options).value_or_throw();
  for (const double seconds : {0.5, 2.5, 1.5, 3.5, 0.5}) {
    float shown = 0;
    do {
      shown = volumes->at(options, seconds, volumes::VolumeWait::never)[0].frame->density.high;
    } while (volumes->is_behind());
    EXPECT_EQ(shown, std::floor(seconds) + 1);
  }
}

TEST_F(VolumesTest, ADamagedFrameShowsTheOneBeforeAndWarnsOnce) {
  save_frames("f_#.brv", {1, 3});
  std::ofstream(folder_ / "f_2.brv") << "not a volume";
  const auto options = options_of("f_%d.brv");
  const LogLines log;
  const auto volumes = volumes::Volumes::load(options).value_or_throw();
  EXPECT_EQ(volumes->at(options, 1.5)[0].frame->density.high, 1);
  for (const double seconds : {0.5, 1.5, 2.5, 1.5, 0.5, 1.5}) volumes->at(options, seconds);
  EXPECT_EQ(log.lines.size(), 1u);
  EXPECT_TRUE(log.has("f_2.brv: not a .brv file; the frame before it is shown"));
}

// Quitting in the middle of any of it.
TEST_F(VolumesTest, EndsWhileItLoads) {
  for (int number = 1; number <= 30; ++number)
    save("f_" + std::to_string(number) + ".brv", {cube("density", 1)});
  const auto options = options_of("f_%d.brv");
  for (int i = 0; i < 20; ++i) {
    const auto volumes = volumes::Volumes::load(options).value_or_throw();
    for (int frame = 0; frame <= i; ++frame) volumes->at(options, frame, volumes::VolumeWait::never);
  }
}

TEST(FairParts, GiveWhatIsWantedOrAFairPart) {
  const auto parts = [](std::vector<std::uint64_t> wanted, std::uint64_t total) {
    return volumes::fair_parts(wanted, total);
  };
  using Parts = std::vector<std::uint64_t>;
  EXPECT_EQ(parts({}, 10), Parts());
  EXPECT_EQ(parts({3, 4}, 10), Parts({3, 4}));
  EXPECT_EQ(parts({30, 4}, 10), Parts({6, 4}));
  EXPECT_EQ(parts({30, 40, 1}, 11), Parts({5, 5, 1}));
  EXPECT_EQ(parts({30, 40, 50}, 0), Parts({0, 0, 0}));
}

// Of three volumes that do not fit together, the small one stays as it is, and each large one has a warning.
TEST_F(VolumesTest, VolumesThatDoNotFitTogetherAreReducedAlike) {
  const auto cubes = [](int edge) {
    grids::Grid grid = cube("density", 1);
    const std::vector<std::byte> values = grid.values;
    const grids::Brick brick = grid.bricks[0];
    grid.bricks.clear();
    grid.values.clear();
    for_each_in(Box<int>{glm::ivec3(0), glm::ivec3(edge)}, [&](glm::ivec3 at) {
      grid.bricks.push_back(brick);
      grid.bricks.back().origin = 8 * at;
      grid.values.insert(grid.values.end(), values.begin(), values.end());
    });
    return grid;
  };
  std::vector<scene::VolumeOptions> options(3);
  options[0].file = save("large.brv", {cubes(8)});   // 10^3 bricks with those around
  options[1].file = save("small.brv", {cubes(1)});   // 3^3
  options[2].file = save("larger.brv", {cubes(9)});  // 11^3
  const LogLines log;
  const auto volumes = volumes::Volumes::load(options).value_or_throw();
  volumes->limit({3000, 1u << 20}).value_or_throw();
  EXPECT_TRUE(log.lines.empty()) << "all fit";
  volumes->limit({1200, 1u << 20}).value_or_throw();
  std::uint64_t bricks = 0;
  std::vector<int> levels;
  for (const volumes::VolumeAt& at : volumes->at(options, 0)) {
    bricks += volumes::room_of(*at.frame).bricks;
    levels.push_back(at.frame->density.level);
  }
  EXPECT_LE(bricks, 1200u);
  EXPECT_EQ(levels, (std::vector<int>{1, 0, 1}));
  EXPECT_EQ(log.lines.size(), 2u);
  EXPECT_TRUE(log.has("large.brv: grid density is shown at 1/2"));
  EXPECT_TRUE(log.has("larger.brv: grid density is shown at 1/2"));
}

TEST_F(VolumesTest, ChoosesGridsByNameAndByTheUsualNames) {
  const auto path =
      save("a.brv", {cube("temperature", 2), cube("fuel", 3), cube("density", 4), cube("flame", 1)});
  scene::VolumeOptions options;
  options.file = path;
  const auto usual = volumes::load_volume_frame(path, options).value_or_throw();
  EXPECT_EQ(usual->density.high, 4);
  ASSERT_TRUE(usual->heat);
  EXPECT_EQ(usual->heat->high, 2);
  options.density = "fuel";
  EXPECT_EQ(volumes::load_volume_frame(path, options).value_or_throw()->density.high, 3);
  options.density = "densty";
  const auto wrong = volumes::load_volume_frame(path, options);
  EXPECT_EQ(wrong.failure().code, ErrorCode::bad_input);
  EXPECT_NE(wrong.failure().message.find("did you mean \"density\""), std::string::npos)
      << wrong.failure().message;
  // No usual name: the first grid of numbers.
  const auto odd = save("b.brv", {cube("cloud_17", 5)});
  EXPECT_EQ(volumes::load_volume_frame(odd, {}).value_or_throw()->density.high, 5);
  // Whole numbers, too; of vectors only by name.
  grids::Grid whole = cube("labels", 0);
  whole.type = grids::ValueType::int32;
  const std::int32_t seven = 7;
  std::memcpy(whole.values.data(), &seven, sizeof seven);
  EXPECT_EQ(volumes::load_volume_frame(save("c.brv", {whole}), {}).value_or_throw()->density.high, 7);
  grids::Grid vectors = cube("v", 1);
  vectors.type = grids::ValueType::vec3f;
  vectors.values.resize(grids::kBrickVoxels * sizeof(glm::vec3));
  const auto no_numbers = volumes::load_volume_frame(save("d.brv", {vectors}), {});
  ASSERT_FALSE(no_numbers);
  EXPECT_NE(no_numbers.failure().message.find("only \"v\" (vec3f"), std::string::npos)
      << no_numbers.failure().message;
}

// Solvers of smoke keep a temperature that lifts it; those of fire a flame beside it, or kelvin.
TEST_F(VolumesTest, HeatGlowsWhereSomethingBurns) {
  const auto heat_of = [&](std::vector<grids::Grid> grids, const scene::VolumeOptions& options = {}) {
    grids.push_back(cube("density", 1));
    return volumes::load_volume_frame(save("a.brv", std::move(grids)), options).value_or_throw();
  };
  EXPECT_FALSE(heat_of({cube("temperature", 1)})->heat) << "it lifts smoke";
  EXPECT_FALSE(heat_of({cube("temperature", 1), cube("flame", 0)})->heat) << "nothing burns";
  EXPECT_FALSE(heat_of({cube("temperature", 1500), cube("flames", 0)})->heat) << "nothing burns";
  EXPECT_TRUE(heat_of({cube("temperature", 1), cube("flame", 0.5f)})->heat);
  EXPECT_TRUE(heat_of({cube("burn", 0.5f)})->heat);
  scene::VolumeOptions options;
  const auto kelvin = heat_of({cube("temperature", 1500)});
  ASSERT_TRUE(kelvin->heat);
  EXPECT_EQ(volumes::kelvin_of(options, *kelvin), 1);
  EXPECT_EQ(volumes::kelvin_of(options, *heat_of({cube("temperature", 1), cube("flame", 0.5f)})), 1000);
  // What the options say counts.
  options.kelvin = 1900;
  EXPECT_TRUE(heat_of({cube("temperature", 1)}, options)->heat);
  EXPECT_EQ(volumes::kelvin_of(options, *kelvin), 1900);
  options = {};
  options.heat = "temperature";
  EXPECT_TRUE(heat_of({cube("temperature", 1), cube("flame", 0)}, options)->heat);
  // Beside masks, too.
  options.masks.resize(1);
  options.masks[0].grid = "density";
  EXPECT_TRUE(heat_of({cube("temperature", 1)}, options)->heat);
  options.heat = "none";
  EXPECT_FALSE(heat_of({cube("temperature", 1)}, options)->heat);
  options.masks.clear();
  EXPECT_FALSE(heat_of({cube("temperature", 1), cube("flame", 1)}, options)->heat);
  EXPECT_TRUE(heat_of({cube("none", 1)}, options)->heat) << "a grid of that name";
}

TEST_F(VolumesTest, GridsOfColoursAndOtherGridsAreChosenWhileItPlays) {
  grids::Grid colors = cube("Cd", 0.5f);
  colors.type = grids::ValueType::vec3f;
  colors.values.resize(grids::kBrickVoxels * sizeof(glm::vec3));
  save("a.brv", {cube("density", 2), cube("fuel", 3), colors});
  auto options = options_of("a.brv");
  const auto volumes = volumes::Volumes::load(options).value_or_throw();
  ASSERT_TRUE(volumes->typical_frame(0).colors);
  EXPECT_EQ(volumes->typical_frame(0).colors->slot_count(),
            volumes->typical_frame(0).density.volume->slot_count());
  EXPECT_EQ(volumes->typical_frame(0).color_grids, std::vector<std::string>{"Cd"});
  EXPECT_EQ(volumes->typical_frame(0).number_grids, (std::vector<std::string>{"density", "fuel"}));
  EXPECT_EQ(volumes::range_of(options[0], volumes->typical_frame(0)), glm::vec2(0, 2));
  options[0].density = "fuel";
  EXPECT_EQ(volumes->at(options, 0)[0].frame->density.high, 3);
  // On failure those before remain.
  scene::VolumeOptions wrong = options[0];
  wrong.color = "fuel";
  const auto refused = volumes->choose_grids(0, wrong);
  EXPECT_NE(refused.failure().message.find("expected colours, which are vec3f or vec3d"), std::string::npos)
      << refused.failure().message;
  EXPECT_EQ(volumes->typical_frame(0).density.high, 3);
}

TEST_F(VolumesTest, AnOpacityCurveDoesNotChangeHowDenseTheFirstViewIs) {
  save("a.brv", {cube("density", 0.3f)});
  const auto extinction = [&](std::vector<scene::OpacityPoint> opacity) {
    FirstViewOptions options;
    options.opacity = std::move(opacity);
    return load_scenario(folder_ / "a.brv", {}, options).value_or_throw().timeline.volumes[0].extinction;
  };
  // The value is everywhere 0.3, and the curve there its half: twice the extinction of a factor of 1.
  const float plain = extinction({}) * 0.3f;
  EXPECT_NEAR(extinction({{0, 1}, {1, 1}}), plain, 1e-3f * plain);
  EXPECT_NEAR(extinction({{0, 0.5f}, {1, 0.5f}}), 2 * plain, 2e-3f * plain);
}

TEST_F(VolumesTest, AVolumeAloneTakesAllPictureSettingsButBounces) {
  save("a.brv", {cube("density", 1)});
  FirstViewOptions options;
  options.picture = {-1.0f, 8, scene::ToneCurve::standard};
  const scene::Timeline timeline = load_scenario(folder_ / "a.brv", {}, options).value_or_throw().timeline;
  EXPECT_EQ(timeline.exposure, -1);
  EXPECT_EQ(timeline.bounces, 0u);
  EXPECT_EQ(timeline.tone, scene::ToneCurve::standard);
}

// A file alone may place its volume where timelines may not.
TEST_F(VolumesTest, SettingsBesideAFarVolumeCanChange) {
  save("a.brv", {cube("density", 1)});
  Scenario scenario = load_scenario(folder_ / "a.brv", {}).value_or_throw();
  scenario.timeline.volumes[0].position_world.x = 2e6f;
  const auto live = EditableScenario::create(std::move(scenario)).value_or_throw();
  scene::Timeline settings = live->scenario().timeline;
  settings.exposure = 1;
  EXPECT_TRUE(live->set_settings(settings));
  settings.volumes[0].extinction = 2;
  EXPECT_EQ(live->set_settings(settings).failure().message,
            "[[volume]] a.brv: \"position\": expected a number from -1e+06 to 1e+06, found 2e+06");
  EXPECT_EQ(live->scenario().timeline.exposure, 1);
}

TEST_F(VolumesTest, APlacedVolumeIsWhereTheTimelineSays) {
  save("a.brv", {cube("density", 1)});
  std::ofstream(folder_ / "t.toml")
      << "version = 1\nscene = \"a.brv\"\n[[volume]]\nfile = \"a.brv\"\nposition = [10.0, 0.0, 0.0]\n"
         "rotation = [-90.0, 0.0, 0.0]\nscale = 2.0\n";
  const Scenario scenario = load_scenario(folder_ / "t.toml", {}).value_or_throw();
  // Voxels 0 to 7 with half a voxel around them, and another half that filtering reaches: z becomes y, y -z.
  const Box<float> bounds = scene::world_bounds(scenario.scene);
  EXPECT_LT(glm::length(bounds.low - glm::vec3(8, -2, -16)), 1e-4f);
  EXPECT_LT(glm::length(bounds.high - glm::vec3(26, 16, 2)), 1e-4f);
  EXPECT_EQ(files_of(scenario).size(), 1u);
}

// A cloud of kilometres over a level in small voxels.
TEST_F(VolumesTest, AVolumeMayBeLargerThanAnyGridOfSmoke) {
  save("a.brv", {cube("density", 1)});
  std::ofstream(folder_ / "box.obj") << "v 0 0 0\nv 3 0 0\nv 0 2 1\nf 1 2 3\n";
  for (const std::string scene : {"box.obj", "a.brv"}) {
    std::ofstream(folder_ / "t.toml")
        << "version = 1\nscene = \"" << scene << "\"\n[[volume]]\nfile = \"a.brv\"\nscale = 1000.0\n";
    const auto scenario = load_scenario(folder_ / "t.toml", {});
    ASSERT_TRUE(scenario) << scenario.failure().message;
    EXPECT_LT(scenario->voxels.grid.layout().size.x, 512) << scene;
    EXPECT_GT(scene::world_bounds(scenario->scene).high.x, 7000);
  }
}

// Their hull is that of all bricks, cut to the bounds.
TEST_F(VolumesTest, CornersSurroundWhatIsDense) {
  grids::Grid grid = cube("density", 1);
  scene::VolumeOptions options;
  options.file = save("a.brv", {grid});
  options.position_world = {1, 2, 3};
  const auto volumes = volumes::Volumes::load(std::array{options}).value_or_throw();
  const std::vector<glm::vec3> corners = volumes::corners_of(options, *volumes, 0);
  Box<float> box = kEmptyBox;
  for (const glm::vec3 p : corners) box = united(box, {p, p});
  const Box<float> bounds = volumes::place_of(options, volumes->extent(0)).bounds_world;
  EXPECT_LT(glm::length(box.low - bounds.low) + glm::length(box.high - bounds.high), 1e-5f);
}

TEST_F(VolumesTest, AxesPlaceAVolumeByAnyAffineTransform) {
  scene::VolumeOptions options;
  options.position_world = {1, 2, 3};
  options.rotation = {0, 90, 0};
  options.scale = 2;
  options.x_axis = {3, 0, 0};
  options.y_axis = {0.5f, 1, 0};
  options.z_axis = {0, 0, -1};
  const glm::mat4 world = volumes::world_from_file(options);
  // A quarter turn about y: x becomes -z, z becomes x.
  const auto at = [&](float x, float y, float z) { return glm::vec3(world * glm::vec4(x, y, z, 1)); };
  EXPECT_LT(glm::length(at(1, 0, 0) - glm::vec3(1, 2, -3)), 1e-5f);
  EXPECT_LT(glm::length(at(0, 1, 0) - glm::vec3(1, 4, 2)), 1e-5f);
  EXPECT_LT(glm::length(at(0, 0, 1) - glm::vec3(-1, 2, 3)), 1e-5f);
  options.file = save("a.brv", {cube("density", 1)});
  options.place = "t.toml:5:8";
  EXPECT_TRUE(volumes::Volumes::load(std::array{options}));
  options.z_axis = options.x_axis + 2.0f * options.y_axis;
  const auto flat = volumes::Volumes::load(std::array{options});
  EXPECT_EQ(flat.failure().code, ErrorCode::bad_input);
  EXPECT_NE(flat.failure().message.find("t.toml:5:8: "), std::string::npos) << flat.failure().message;
}

// Alone it gets a look that does not depend on its unit.
TEST_F(VolumesTest, TheFirstViewDoesNotDependOnTheUnit) {
  std::optional<Scenario> metres;
  for (const double unit : {1.0, 1000.0, 1e-3}) {
    grids::Grid grid = cube("density", 0.3f);
    grid.world_from_index = glm::dmat4(unit);
    grid.world_from_index[3][3] = 1;
    Scenario scenario = load_scenario(save("a.brv", {grid}), {}).value_or_throw();
    EXPECT_TRUE(scenario.timeline.smokes.empty());
    if (!metres) {
      metres = std::move(scenario);
      continue;
    }
    const float ratio =
        scene::world_bounds(scenario.scene).high.y / scene::world_bounds(metres->scene).high.y;
    EXPECT_NEAR(scenario.timeline.volumes[0].extinction * ratio, metres->timeline.volumes[0].extinction,
                1e-3f * metres->timeline.volumes[0].extinction);
    EXPECT_LT(glm::length(scenario.camera.position_world / ratio - metres->camera.position_world), 0.01f);
  }
}

}  // namespace
}  // namespace brume::scenario
