#include "scenario/editable_scenario.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <functional>
#include <random>

#include "image/png.hpp"
#include "scene/files/timeline_reader.hpp"
#include "scene/files/timeline_writer.hpp"
#include "tests/sanitized.hpp"
#include "tests/scenario/two_rooms.hpp"
#include "tests/scene/random_timeline.hpp"
#include "tests/work_folder.hpp"

namespace brume::scenario {
namespace {

namespace fs = std::filesystem;
using glm::vec3;

/// Random actions of a player in the two rooms, from a seed.
class Player {
 public:
  Player(std::uint32_t seed, fs::path folder) : random_(seed), folder_(std::move(folder)) {}

  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(random_() % count); }
  /// Tick times and times between ticks, with many duplicates.
  double time() { return below(40) * 0.125 + (below(3) == 0 ? below(4) * 0.004 : 0.0); }
  vec3 place() {
    const auto real = [&](float low, float high) {
      return low + (high - low) * static_cast<float>(below(1000)) / 1000;
    };
    const float x = real(-3.8f, 3.8f), y = real(0.2f, 2.8f);
    return {x, y, real(-1.8f, 1.8f)};
  }
  std::pair<vec3, vec3> aim() {
    const vec3 from = place();
    return {from, from + vec3(below(2) == 0 ? 1.5f : -1.5f, 0.1f, 0.3f)};
  }
  scene::ShotEvent shot(double time) {
    scene::ShotEvent shot;
    shot.time = time;
    std::tie(shot.from_world, shot.toward_world) = aim();
    shot.radius = 0.1f + 0.01f * static_cast<float>(below(30));
    shot.times.stay = 4;
    if (below(3) == 0) shot.shape = scene::ShotShape::box;
    if (below(5) == 0) {
      shot.shape = scene::ShotShape::mask;
      shot.mask = folder_ / (std::to_string(below(3)) + ".png");
    }
    return shot;
  }
  scene::TextEvent text(double time) {
    scene::TextEvent text;
    text.time = time;
    text.text = std::vector<const char*>{"AB", "BRUME", "e"}[below(3)];
    std::tie(text.from_world, text.toward_world) = aim();
    text.times.stay = 4;
    text.interval = below(2) == 0 ? 0.0f : 0.25f;
    return text;
  }

  /// One action, sometimes several at once.
  scene::Timeline actions() {
    scene::Timeline actions;
    for (std::uint32_t count = below(4) == 0 ? 3 : 1; count > 0; --count) {
      const double now = time();
      switch (below(12)) {
        case 0:
        case 1:
          actions.smokes.push_back({now, place(), place()});
          break;
        case 2:
          actions.texts.push_back(text(now));
          break;
        case 3:
          actions.blasts.push_back({now, place()});
          break;
        case 4:
        case 5:
          actions.moves.push_back({now, std::string(1, static_cast<char>('a' + below(4))), place()});
          break;
        case 6: {
          const vec3 low = place();
          actions.edits.push_back({now, low, low + vec3(0.5f, 0.7f, 0.6f), below(2) == 0});
          break;
        }
        case 7:
          actions.doors.push_back({now, below(3) == 0 ? "poster" : "door", below(2) == 0});
          break;
        default:
          actions.shots.push_back(shot(now));
      }
    }
    return actions;
  }

 private:
  std::mt19937 random_;
  fs::path folder_;
};

class EditableScenarioTest : public testing::Test {
 protected:
  EditableScenarioTest() {
    fs::create_directories(folder / "out");
    for (int i = 0; i < 3; ++i) {
      image::Image8 picture{6, 6, std::vector<std::uint8_t>(144, 255)};
      for (int k = 0; k < 4 * (i % 2 + 1); ++k) picture.rgba[static_cast<std::size_t>(k)] = 0;
      image::save_png(folder / (std::to_string(i) + ".png"), picture).value_or_throw();
    }
  }

  static Scenario empty_rooms() {
    Scenario scenario = two_rooms();
    scenario.timeline.smoke.voxels = 1500;
    scenario.timeline.scene = "rooms.glb";
    return scenario;
  }
  static std::unique_ptr<EditableScenario> rooms() {
    return EditableScenario::create(empty_rooms()).value_or_throw();
  }

  /// Saves the timeline and loads it into a new scenario.
  Scenario reloaded(const scene::Timeline& timeline) const {
    const fs::path file = folder / "out/take.toml";
    scene::save_timeline(file, timeline).value_or_throw();
    Scenario scenario = empty_rooms();
    scenario.timeline = scene::load_timeline(file).value_or_throw();
    auto masks = load_masks(scenario.timeline).value_or_throw();
    scenario.masks = std::move(masks.atlas);
    scenario.shot_masks = std::move(masks.of_shots);
    return scenario;
  }

  /// Checks that the live scenario matches its timeline now and at other times.
  void expect_as_saved(EditableScenario& live, std::initializer_list<double> times) const {
    const Scenario scenario = reloaded(live.scenario().timeline);
    EXPECT_EQ(scenario.masks.key(), live.scenario().masks.key());
    const auto expected = Simulation::create(scenario).value_or_throw();
    const auto log = live.simulation().world().log(), other = expected->world().log();
    EXPECT_TRUE(std::equal(log.begin(), log.end(), other.begin(), other.end()));
    for (const double time : times) {
      live.advance_to(time);
      expected->advance_to(time);
      EXPECT_EQ(live.simulation().world().state_hash(), expected->world().state_hash()) << time << " s";
      const auto hidden = live.simulation().hidden_objects(), others = expected->hidden_objects();
      EXPECT_TRUE(std::equal(hidden.begin(), hidden.end(), others.begin(), others.end())) << time << " s";
      expect_same_picture(live.simulation(), *expected);
    }
  }
  /// The message of an edit that fails and changes nothing.
  static std::string refusal(const EditableScenario& live, const std::function<Result<void>()>& edit) {
    const std::string before = scene::format_timeline(live.scenario().timeline, "");
    const std::uint64_t hash = live.simulation().world().state_hash();
    const auto done = edit();
    EXPECT_FALSE(done);
    EXPECT_EQ(scene::format_timeline(live.scenario().timeline, ""), before);
    EXPECT_EQ(live.simulation().world().state_hash(), hash);
    return done.failure().message;
  }
  /// Smoke as rays read it, and the surfaces.
  static void expect_same_picture(const Simulation& a, const Simulation& b) {
    const glm::ivec3 size = a.world().grid().size();
    int planes = 0, densities = 0;
    for_each_in({glm::ivec3(-1), size}, [&](glm::ivec3 cell) {
      const auto p = a.field().planes()(cell), q = b.field().planes()(cell);
      planes += !std::equal(p.begin(), p.end(), q.begin(), q.end());
    });
    for (float z = 0.3f; z < 28; z += 1.7f)
      for (float y = 0.3f; y < 20; y += 1.7f)
        for (float x = 0.3f; x < 44; x += 1.1f)
          densities += sample_density(a.volume(), {x, y, z}) != sample_density(b.volume(), {x, y, z});
    EXPECT_EQ(planes, 0);
    EXPECT_EQ(densities, 0);
  }

  const cli::WorkFolder work_folder;
  const fs::path folder = work_folder.path();
};

TEST_F(EditableScenarioTest, MatchesItsTimelineAtEveryTime) {
  for (std::uint32_t seed = 0; seed < (kSanitized ? 2 : 6); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Player player(seed, folder);
    const auto live = rooms();
    for (int i = 0; i < 30; ++i) {
      if (i % 3 == 0) live->advance_to(player.time());
      const auto done = live->add(player.actions());
      ASSERT_TRUE(done) << done.failure().message;
      if (i % 10 == 7) {
        scene::Timeline settings = live->scenario().timeline;
        settings.smoke.voxels = 800 + player.below(1500);
        settings.smoke.hold = 0.5f * static_cast<float>(player.below(5));
        settings.smoke.erosion = 0.25f;
        ASSERT_TRUE(live->set_settings(settings));
      }
      if (i % 10 == 9)
        expect_as_saved(*live, {live->simulation().world().tick() / 64.0, player.time(), player.time()});
      if (HasFailure()) return;
    }
  }
}

TEST_F(EditableScenarioTest, IsIndependentOfTheOrderOfActions) {
  // Simultaneous events of one kind keep the order of the actions, so all times differ here.
  Player player(100, folder);
  std::vector<scene::Timeline> actions;
  for (int i = 0; i < 30; ++i) {
    scene::Timeline one = player.actions();
    scene::for_each_event_list(one, [&](const char*, auto& list) {
      for (auto& event : list) event.time += i * 1e-4 + 1e-6 * static_cast<double>(&event - list.data());
    });
    actions.push_back(std::move(one));
  }
  std::uint64_t hash = 0;
  std::mt19937 random(3);
  for (int order = 0; order < 3; ++order) {
    const auto live = rooms();
    for (const scene::Timeline& one : actions) {
      live->advance_to(player.time());
      ASSERT_TRUE(live->add(one));
    }
    live->advance_to(4.5);
    if (order == 0) hash = live->simulation().world().state_hash();
    EXPECT_EQ(live->simulation().world().state_hash(), hash);
    EXPECT_GT(live->simulation().world().state().holes.size(), 2u);
    std::shuffle(actions.begin(), actions.end(), random);
  }
}

TEST_F(EditableScenarioTest, AddsAllActionsOrNone) {
  const auto live = rooms();
  live->advance_to(1);
  const auto refused = [&](const std::function<void(scene::Timeline&)>& make) {
    scene::Timeline actions;
    actions.shots = {Player(1, folder).shot(0.5)};
    actions.doors = {{0.5, "door", true}};
    make(actions);
    return refusal(*live, [&] { return live->add(actions); });
  };
  EXPECT_EQ(refused([](auto& t) { t.shots[0].radius = 20; }),
            "shot at 0.5 s: \"radius\": expected a number from 0.01 to 10, found 20");
  EXPECT_EQ(refused([](auto& t) { t.doors[0].object = "dor"; }),
            "the scene has no object \"dor\"; did you mean \"door\"?");
  EXPECT_NE(refused([](auto& t) {
              t.blasts = {{1, vec3(0)}};
              t.blasts[0].radius = 100;
            }).find("blast at tick 64: expected a radius"),
            std::string::npos);
  EXPECT_NE(refused([&](auto& t) {
              t.shots[0].shape = scene::ShotShape::mask;
              t.shots[0].mask = folder / "none.png";
            }).find("none.png"),
            std::string::npos);
  EXPECT_NE(refused([&](auto& t) {
              t.texts = {Player(1, folder).text(1)};
              t.texts[0].text = " ";
            }).find("no visible letter"),
            std::string::npos);
}

TEST_F(EditableScenarioTest, TakesOverAllOfATimelineOrNothing) {
  const auto live = rooms();
  live->add(Player(1, folder).actions()).value_or_throw();
  live->advance_to(1);
  for (const auto edit : {&EditableScenario::set_settings, &EditableScenario::reset}) {
    const auto refused = [&](const std::function<void(scene::Timeline&)>& make) {
      scene::Timeline settings = live->scenario().timeline;
      settings.sky.stars = 0.5f;
      make(settings);
      return refusal(*live, [&] { return (live.get()->*edit)(settings); });
    };
    EXPECT_EQ(refused([](auto& t) { t.smoke.voxels = 0; }),
              "[smoke]: \"voxels\": expected a number from 1 to 1.67772e+07, found 0");
    EXPECT_EQ(refused([](auto& t) { t.bounces = 17; }),
              "the timeline: \"bounces\": expected a number from 0 to 16, found 17");
    EXPECT_EQ(refused([](auto& t) { t.camera.resize(2); }),
              "camera at 0 s: \"time\": expected a later time than the previous key's");
    EXPECT_NE(refused([&](auto& t) {
                t.camera.resize(1);
                t.camera[0].camera.lens.opening = folder / "none.png";
              }).find("none.png"),
              std::string::npos);
    EXPECT_EQ(refused([](auto& t) { t.scene = "other.glb"; }),
              "other.glb: expected the scenario's own scene, rooms.glb");
    EXPECT_EQ(refused([](auto& t) { t.grid.voxel = 0.5f; }),
              "the timeline has another grid than the scenario; load it as a new scenario");
  }
}

TEST_F(EditableScenarioTest, TakesOverSettingsAndKeepsItsEvents) {
  const auto live = rooms();
  live->add(Player(1, folder).actions()).value_or_throw();
  live->advance_to(1);
  const std::uint64_t hash = live->simulation().world().state_hash();
  scene::Timeline settings = live->scenario().timeline;
  scene::Drawing draw(1);
  visit_picture_options(settings, draw);
  visit_sky_options(settings.sky, draw);
  settings.camera = {{1, {}}, {2, {}}};
  const std::string expected = scene::format_timeline(settings, folder / "out");
  EXPECT_NE(expected, scene::format_timeline(live->scenario().timeline, folder / "out"));
  scene::for_each_event_list(settings, [](const char*, auto& events) { events.clear(); });
  settings.blasts = {{0.5, vec3(0, 1, 0)}};
  settings.grid = {settings.grid.voxel, {}, {}};
  EXPECT_TRUE(live->set_settings(settings));
  EXPECT_EQ(live->simulation().world().state_hash(), hash);
  EXPECT_EQ(scene::format_timeline(live->scenario().timeline, folder / "out"), expected);
  EXPECT_EQ(scene::format_timeline(reloaded(live->scenario().timeline).timeline, folder / "out"), expected);
  expect_as_saved(*live, {1, 2});
}

TEST_F(EditableScenarioTest, ResetRestoresTheInitialState) {
  const auto live = rooms();
  const scene::Timeline first = live->scenario().timeline;
  live->advance_to(3);
  const std::uint64_t hash = live->simulation().world().state_hash();
  Player player(8, folder);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(live->add(player.actions()));
  EXPECT_NE(live->simulation().world().state_hash(), hash);
  EXPECT_GT(live->scenario().masks.count(), 0u);
  ASSERT_TRUE(live->reset(first));
  live->advance_to(3);
  EXPECT_EQ(live->simulation().world().state_hash(), hash);
  EXPECT_EQ(live->scenario().masks.count(), 0u);
  EXPECT_TRUE(live->simulation().hidden_objects().empty());
  expect_as_saved(*live, {3, 1});
}

TEST_F(EditableScenarioTest, ARecordingOfTheDemoReloadsToTheSameState) {
  // Starts from the files of the demo: a throw, twenty shots, a word, a blast, a door, a path.
  const fs::path demo = fs::path(BRUME_SOURCE_DIR) / "scenes/demo.toml";
  const auto live = EditableScenario::create(load_scenario(demo, {}).value_or_throw()).value_or_throw();
  const auto play = [&](double time, const std::function<void(scene::Timeline&)>& make) {
    scene::Timeline actions;
    make(actions);
    live->advance_to(time);
    live->add(actions).value_or_throw();
  };
  const vec3 eye(-5.2f, 1.35f, 10.8f), door(-2.75f, 1.55f, 0);
  play(0.2, [&](auto& t) { t.smokes = {{0.2, eye, door + vec3(2, 0, 0)}}; });
  for (int i = 0; i < 20; ++i)
    play(1 + 0.1 * i, [&](auto& t) {
      t.shots.resize(1);
      t.shots[0].time = 1 + 0.1 * i;
      t.shots[0].from_world = eye;
      t.shots[0].toward_world = door + vec3(0.1f * static_cast<float>(i), 0, 0);
    });
  play(2, [&](auto& t) { t.doors = {{2, "door_leaf", true}}; });
  play(3.1, [&](auto& t) {
    t.texts.resize(1);
    t.texts[0].time = 3.1;
    t.texts[0].text = "BRUME";
    t.texts[0].from_world = eye;
    t.texts[0].toward_world = door;
  });
  play(3.5, [&](auto& t) { t.blasts = {{3.5, door}}; });
  scene::Timeline settings = live->scenario().timeline;
  settings.camera = {{0, {eye, door, 1}}, {4, {eye + vec3(3, 0, 0), door, 1}}};
  live->set_settings(settings).value_or_throw();

  const fs::path file = folder / "out/take.toml";
  scene::save_timeline(file, live->scenario().timeline).value_or_throw();
  const Scenario scenario = load_scenario(file, {}).value_or_throw();
  EXPECT_EQ(scene::format_timeline(scenario.timeline, folder / "out"),
            scene::format_timeline(live->scenario().timeline, folder / "out"));
  const auto played = Simulation::create(scenario).value_or_throw();
  for (const double time : {4.0, 3.2, 1.5}) {
    live->advance_to(time);
    played->advance_to(time);
    EXPECT_EQ(live->simulation().world().state_hash(), played->world().state_hash()) << time;
  }
}

TEST_F(EditableScenarioTest, KeepsItsGridWhenReloaded) {
  const auto live = rooms();
  const scene::GridOptions& grid = live->scenario().timeline.grid;
  const voxel::GridLayout& layout = live->scenario().voxels.grid.layout();
  EXPECT_EQ(*grid.size, layout.size);
  EXPECT_EQ(*grid.origin_world, layout.origin_world);
  EXPECT_EQ(grid.voxel, layout.voxel_size);
}

/// CPU time of this thread, which does not depend on the load of the machine.
double cpu_seconds_of(const std::function<void()>& work) {
  const auto now = [] {
    timespec time{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  const double start = now();
  work();
  return now() - start;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

TEST_F(EditableScenarioTest, AShotIntoARunningWorldIsCheap) {
  // Shots into a grown smoke, one per tick, must not replay the past. Shots into the past do, and serve as
  // the reference on any machine. Shots must not read files either, so these are removed.
  const auto live = rooms();
  live->advance_to(3);
  Player player(5, folder);
  std::filesystem::remove_all(folder);
  const auto cost_of = [&](double now) {
    scene::Timeline actions;
    actions.shots = {player.shot(now)};
    actions.shots[0].shape = scene::ShotShape::cylinder;
    actions.shots[0].mask.clear();
    return cpu_seconds_of([&] { ASSERT_TRUE(live->add(actions)); });
  };
  std::vector<double> present, past;
  for (int i = 0; i < 300; ++i) {
    const double now = 3 + i / 64.0;
    live->advance_to(now);
    present.push_back(cost_of(now));
    if (i % 10 == 0) past.push_back(cost_of(0.5));
  }
  RecordProperty("shot_median_ns", static_cast<int>(1e9 * median(present)));
  RecordProperty("past_shot_median_ns", static_cast<int>(1e9 * median(past)));
  EXPECT_LT(median(present), 0.1 * median(past));
}

}  // namespace
}  // namespace brume::scenario
