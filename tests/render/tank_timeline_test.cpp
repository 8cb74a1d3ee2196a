// [[tank]] of timelines: loaded once, placed, moved with carriers, shared among the samples of a picture.
#include <algorithm>
#include <set>

#include "film/playback.hpp"
#include "scenario/editable_scenario.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/work_folder.hpp"

namespace brume::render {
namespace {

constexpr const char* kTank =
    "version = 1\n[tank]\nsize = [20, 20, 20]\nvoxel = 0.05\nspheres = 20\nradius = [2.0, 6.0]\n"
    "view = \"voxels\"\n[sky]\nambient = [0.5, 0.5, 0.5]\n[[light]]\nposition = [0.0, 2.0, 0.0]\n";
constexpr const char* kLevel =
    "version = 1\nscene = \"level.obj\"\nduration = 2.0\n[grid]\nvoxel = 0.5\n"
    "[[camera]]\ntime = 0.0\nposition = [0.0, 1.0, 4.0]\ntarget = [0.0, 1.0, 0.0]\n"
    "[[carrier]]\nname = \"cart\"\n[[carrier.key]]\ntime = 0.0\nposition = [1.0, 2.0, 3.0]\n"
    "rotation = [0.0, 90.0, 0.0]\n[[carrier.key]]\ntime = 2.0\nposition = [5.0, 2.0, 3.0]\n"
    "rotation = [0.0, 90.0, 0.0]\n";
constexpr const char* kStanding = "[[tank]]\nfile = \"reef.toml\"\nposition = [0.0, 1.0, 0.0]\n";

class TankTimelineTest : public gpu::GpuTest {
 protected:
  TankTimelineTest() {
    folder_.write("level.obj", "v -4 0 -4\nv 4 0 -4\nv 4 0 4\nv -4 0 4\nf 1 4 3 2\n");
    folder_.write("reef.toml", kTank);
  }
  Result<scenario::Scenario> load(const std::string& tanks) const {
    return scenario::load_scenario(folder_.path() / folder_.write("level.toml", kLevel + tanks), {});
  }
  static FrameInput frame_of(const scenario::Scenario& scenario, double seconds,
                             const scenario::FrameOptions& options = {}) {
    const auto simulation = scenario::Simulation::create(scenario).value_or_throw();
    std::vector<shared::Hole> holes;
    FrameInput input = scenario::frame_input(scenario, *simulation, seconds, holes, options);
    input.smoke = {};
    input.level = {};
    return input;
  }

  const cli::WorkFolder folder_{};
};

TEST_F(TankTimelineTest, StandWhereTheTimelineSays) {
  const auto scenario =
      load(std::string(kStanding) +
           "scale = 2.0\nrotation = [0.0, 90.0, 0.0]\nsamples = 3\nview = \"spheres\"\n" +
           "[[tank]]\nfile = \"reef.toml\"\ncarrier = \"cart\"\nposition = [1.0, 0.0, 0.0]\n")
          .value_or_throw();
  ASSERT_EQ(scenario.tanks.size(), 2u);
  EXPECT_EQ(scenario.tanks[0].content, scenario.tanks[1].content) << "one file is loaded once";
  EXPECT_EQ(scenario.tanks[0].light, scenario.tanks[1].light);
  const FrameInput input = frame_of(scenario, 0);
  ASSERT_EQ(input.tanks.size(), 2u);
  const planning::TankInput &standing = input.tanks[0], &carried = input.tanks[1];
  EXPECT_EQ(standing.placement.position_world, glm::vec3(0, 1, 0));
  EXPECT_EQ(standing.placement.scale, 2);
  EXPECT_EQ(standing.samples, 3u);
  EXPECT_EQ(standing.view, scene::TankView::spheres);
  EXPECT_EQ(carried.view, scene::TankView::voxels) << "that of its file";
  EXPECT_FALSE(standing.continues);
  // A quarter of a turn about y leads x to -z.
  const auto expect_near = [](const glm::vec3& a, const glm::vec3& b) {
    EXPECT_LT(glm::distance(a, b), 1e-5f) << a.x << ' ' << a.y << ' ' << a.z;
  };
  expect_near(standing.placement.axes[0], {0, 0, -1});
  expect_near(carried.placement.axes[0], {0, 0, -1});
  expect_near(carried.placement.position_world, {1, 2, 2});
  FrameInput moved = input;
  scenario::move_frame(scenario, 0, 2, {}, moved);
  expect_near(moved.tanks[1].placement.position_world, {5, 2, 2});
  EXPECT_EQ(moved.tanks[0].placement, standing.placement);
}

TEST_F(TankTimelineTest, SamplesOfAPictureShareThePaths) {
  const auto scenario = load(std::string(kStanding) + "samples = 10\n").value_or_throw();
  for (const std::uint32_t count : {1u, 3u, 40u}) {
    const scenario::FrameSamples samples(scenario, 1, {}, frame_of(scenario, 1), count);
    std::set<std::uint32_t> paths;
    for (std::uint32_t i = 0; i < count; ++i) {
      const planning::TankInput& tank = samples[i].tanks.at(0);
      EXPECT_EQ(tank.samples, (10 + count - 1) / count);
      for (std::uint32_t path = 0; path < tank.samples; ++path) paths.insert(tank.index + path);
    }
    EXPECT_EQ(paths.size(), count * ((10 + count - 1) / count)) << "no path is taken twice";
  }
  const FrameInput film = frame_of(scenario, 1, {.tank_samples = 1});
  EXPECT_EQ(film.tanks.at(0).samples, 1u);
  EXPECT_TRUE(film.tanks.at(0).continues);
}

TEST_F(TankTimelineTest, FilesAreNamedAndFaultsHaveTheirPlace) {
  const auto scenario = load(kStanding).value_or_throw();
  EXPECT_TRUE(std::ranges::count(scenario::files_of(scenario), folder_.path() / "reef.toml"));
  EXPECT_FALSE(scenario::is_tank_input(folder_.path() / "level.toml")) << "a level, though it has a tank";
  EXPECT_TRUE(scenario::is_tank_input(folder_.path() / "reef.toml"));
  const auto message = load("[[tank]]\nfile = \"gone.toml\"\n").failure().message;
  EXPECT_NE(message.find("level.toml:"), message.npos) << message;
  EXPECT_NE(message.find("gone.toml"), message.npos) << message;
  const auto misspelt = load(std::string(kStanding) + "view = \"balls\"\n").failure().message;
  EXPECT_NE(misspelt.find("\"view\": expected \"spheres\" or \"voxels\""), misspelt.npos) << misspelt;
}

TEST_F(TankTimelineTest, AnEditedTimelineMovesItsTanksAndLoadsNoOthers) {
  const auto live = scenario::EditableScenario::create(load(kStanding).value_or_throw()).value_or_throw();
  scene::Timeline timeline = live->scenario().timeline;
  timeline.tanks[0].position_world.x = 1;
  const auto moved = live->reset(timeline);
  ASSERT_TRUE(moved) << moved.failure().message;
  EXPECT_EQ(frame_of(live->scenario(), 0).tanks.at(0).placement.position_world, glm::vec3(1, 1, 0));
  timeline.tanks[0].file = "other.toml";
  EXPECT_FALSE(live->reset(timeline));
}

TEST_F(TankTimelineTest, ATimeIsOnePictureWhateverCameBefore) {
  const auto with = load(kStanding).value_or_throw(), without = load("").value_or_throw();
  film::Playback playback(context(), with, glm::uvec2(32, 18)), empty(context(), without, glm::uvec2(32, 18));
  const image::Image8 first = playback.draw(1, 0);
  EXPECT_NE(first.rgba, empty.draw(1, 0).rgba);
  EXPECT_EQ(playback.draw(1, 1).rgba, first.rgba);
  playback.draw(0, 2);
  EXPECT_EQ(playback.draw(1, 3).rgba, first.rgba);
}

}  // namespace
}  // namespace brume::render
