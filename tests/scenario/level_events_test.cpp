#include "scenario/level_events.hpp"

#include <gtest/gtest.h>

#include "scenario/simulation.hpp"
#include "tests/scenario/two_rooms.hpp"

namespace brume::scenario {
namespace {

using glm::ivec3;
using glm::vec3;

/// Grid and planes of a scenario without some of its objects.
Voxels rebuilt(Scenario& scenario, const std::string& without) {
  scene::Scene scene = scenario.scene;
  std::erase_if(scene.objects, [&](const scene::Object& o) { return o.name == without; });
  return load_or_voxelize(scene, scenario.voxels.grid.layout(), {}).value_or_throw();
}

void expect_level(const Simulation& simulation, const Voxels& expected) {
  int voxels = 0, planes = 0;
  const ivec3 size = expected.grid.size();
  for_each_in({ivec3(0), size},
              [&](ivec3 v) { voxels += simulation.world().grid().solid(v) != expected.grid.solid(v); });
  for_each_in({ivec3(-1), size}, [&](ivec3 cell) {
    const auto p = simulation.field().planes()(cell), q = expected.planes.at(cell);
    planes += !std::equal(p.begin(), p.end(), q.begin(), q.end());
  });
  EXPECT_EQ(voxels, 0);
  EXPECT_EQ(planes, 0);
}

/// Density of all smoke beyond the wall between the rooms.
std::uint64_t smoke_in_the_east(const Simulation& simulation) {
  std::uint64_t sum = 0;
  const ivec3 size = simulation.world().grid().size();
  for_each_in({ivec3(24, 0, 0), size}, [&](ivec3 v) { sum += simulation.world().state().density(v); });
  return sum;
}

TEST(LevelEvents, ADoorTogglesVoxelsPlanesAndVisibility) {
  Scenario scenario = two_rooms();
  scenario.timeline.doors = {{1.0, "door", true, ""}, {2.0, "door", false, ""}, {3.0, "poster", true, ""}};
  const Voxels open = rebuilt(scenario, "door"), shut = rebuilt(scenario, "nothing");
  const auto simulation = Simulation::create(scenario).value_or_throw();
  const std::vector<std::uint32_t> none, door{9, 10}, poster{11};
  const auto hidden = [&] {
    const auto now = simulation->hidden_objects();
    return std::vector<std::uint32_t>(now.begin(), now.end());
  };
  // Forwards, backwards and in jumps.
  for (const double time : {0.0, 1.0, 1.99, 2.0, 3.0, 1.5, 0.5, 2.5, 1.0, 0.99}) {
    SCOPED_TRACE(time);
    simulation->advance_to(time);
    const bool is_open = time >= 1 && time < 2;
    expect_level(*simulation, is_open ? open : shut);
    EXPECT_EQ(hidden(), is_open ? door : time >= 3 ? poster : none);
  }
}

TEST(LevelEvents, TheNextLevelIsKnownBefore) {
  Scenario scenario = two_rooms();
  scenario.timeline.doors = {{1.0, "door", true, ""},
                             {1.0, "poster", true, ""},
                             {2.0, "door", false, ""},
                             {3.0, "poster", false, ""}};
  scenario.timeline.edits = {{1.5, {-2, 0, -1}, {-1, 1, 1}, true}};
  const auto simulation = Simulation::create(scenario).value_or_throw();
  for (const double time : {0.0, 1.0, 1.5, 2.0, 0.5, 2.5}) {
    SCOPED_TRACE(time);
    simulation->advance_to(time);
    const std::shared_ptr<const planning::NextLevel> next = simulation->next_level();
    ASSERT_TRUE(next);
    EXPECT_EQ(simulation->next_level(), next) << "the same until the level changes";
    for (double later = time; simulation->next_level() == next; later += 0.1) simulation->advance_to(later);
    EXPECT_TRUE(voxel::same_voxels(next->opaque, simulation->world().solids().sight));
    const auto hidden = simulation->hidden_objects();
    EXPECT_EQ(next->hidden_objects, std::vector<std::uint32_t>(hidden.begin(), hidden.end()));
  }
  simulation->advance_to(3);
  EXPECT_FALSE(simulation->next_level());
}

TEST(LevelEvents, SmokePassesOnlyOpenDoors) {
  Scenario scenario = two_rooms();
  scenario.timeline.doors = {{3.0, "door", true, ""}};
  const auto simulation = Simulation::create(scenario).value_or_throw();
  simulation->advance_to(2.98);
  EXPECT_EQ(smoke_in_the_east(*simulation), 0u);
  simulation->advance_to(3.5);
  EXPECT_GT(smoke_in_the_east(*simulation), 0u);
  simulation->advance_to(6.0);
  EXPECT_GT(smoke_in_the_east(*simulation), 255u * 100);
  simulation->advance_to(2.98);
  EXPECT_EQ(smoke_in_the_east(*simulation), 0u);
}

TEST(LevelEvents, TheSmokeVolumeEqualsThatOfTheOpenLevel) {
  // A volume in which the door opened equals one that was built with the door open, at every point.
  Scenario scenario = two_rooms();
  scenario.timeline.doors = {{0.0, "door", true, ""}};
  Scenario other = two_rooms();
  other.voxels = rebuilt(scenario, "door");
  const auto opened = Simulation::create(scenario).value_or_throw(),
             always = Simulation::create(other).value_or_throw();
  for (const double time : {0.5, 2.0}) {
    opened->advance_to(time);
    always->advance_to(time);
    int smoky = 0;
    for (float z = 0.5f; z < 28; z += 0.41f)
      for (float x = 18; x < 26; x += 0.23f) {
        const vec3 p(x, 5.3f, z);
        const float density = smoke::sample_density(opened->volume(), p);
        ASSERT_EQ(density, smoke::sample_density(always->volume(), p)) << x << " " << z;
        smoky += density > 0;
      }
    EXPECT_GT(smoky, time > 1 ? 100 : -1);
  }
}

TEST(LevelEvents, AnEditFillsTheVoxelsWithCentresInside) {
  Scenario scenario = two_rooms();
  const voxel::GridLayout& layout = scenario.voxels.grid.layout();
  EXPECT_EQ(
      voxels_in(layout, layout.origin_world + vec3(0.1f), layout.origin_world + vec3(0.5f, 0.51f, 0.6f)),
      (Box<int>{ivec3(0), ivec3(2, 3, 3)}));
  EXPECT_TRUE(
      voxels_in(layout, layout.origin_world + vec3(0.15f), layout.origin_world + vec3(0.25f)).empty());
  EXPECT_EQ(voxels_in(layout, vec3(-1e6f), vec3(1e6f)), (Box<int>{ivec3(-1), layout.size + 1}));

  // A hole in the wall between the rooms, and the doorway walled up.
  scenario.timeline.edits = {{1.0, {-0.3f, 2.1f, -1.5f}, {0.3f, 2.7f, -0.7f}, false},
                             {2.0, {-0.3f, 0, -0.6f}, {0.3f, 2.1f, 0.6f}, true}};
  scenario.timeline.doors = {{2.0, "door", true, ""}};
  const auto events = level_events(scenario).value_or_throw();
  ASSERT_EQ(events.size(), 3u);
  EXPECT_FALSE(events[0].blocks.empty());
  EXPECT_FALSE(events[1].blocks.empty());
  EXPECT_TRUE(events[2].blocks.empty());  // the edit covers the door
  EXPECT_TRUE(events[2].hidden);
  const auto simulation = Simulation::create(scenario).value_or_throw();
  simulation->advance_to(0.5);
  const ivec3 hole(21, 14, 9), doorway(22, 5, 14);
  EXPECT_TRUE(simulation->world().grid().solid(hole));
  EXPECT_TRUE(simulation->world().grid().free(doorway));
  simulation->advance_to(2.5);
  EXPECT_TRUE(simulation->world().grid().free(hole));
  EXPECT_TRUE(simulation->world().grid().solid(doorway));
  EXPECT_TRUE(simulation->field().planes()(hole).empty());
  simulation->advance_to(4.5);
  EXPECT_GT(smoke_in_the_east(*simulation), 0u);
}

TEST(LevelEvents, EventsAreSortedByTick) {
  Scenario scenario = two_rooms();
  scenario.timeline.doors = {{1.0, "door", true, ""}};
  scenario.timeline.edits = {{1.0, {-3, 1, -1}, {-2, 2, 1}, true}};
  scenario.timeline.shots = {{1.0, {-3, 1, 0}, {3, 1, 0}}};
  scenario.timeline.blasts = {{0.5, {1, 1, 1}}};
  scenario.timeline.moves = {{0.0, "b", {0, 1, 0}}, {0.25, "a", {0, 1, 0}}, {1.0, "b", {1, 1, 0}}};
  const auto events = events_of(scenario).value_or_throw();
  std::vector<std::pair<std::uint32_t, std::size_t>> order;
  for (const sim::Event& event : events) order.emplace_back(sim::tick_of(event), event.index());
  const std::vector<std::pair<std::uint32_t, std::size_t>> expected{{0, 0},  {0, 3},  {16, 3}, {32, 2},
                                                                    {64, 4}, {64, 4}, {64, 1}, {64, 3}};
  EXPECT_EQ(order, expected);
  EXPECT_EQ(std::get<sim::MoveBody>(events[1]).body, 0u);
  EXPECT_EQ(std::get<sim::MoveBody>(events[2]).body, 1u);
  EXPECT_EQ(std::get<sim::MoveBody>(events[7]).body, 0u);
  EXPECT_EQ(std::get<sim::Blast>(events[3]).remaining, 5u);
  const auto slower = events_of(scenario, 20).value_or_throw();
  EXPECT_EQ(sim::tick_of(slower.back()), 20u);
  EXPECT_EQ(std::get<sim::ThrowSmoke>(slower[0]).smoke.hold_ticks, 360u);
}

TEST(LevelEvents, AnUnknownDoorFails) {
  Scenario scenario = two_rooms();
  scenario.timeline.doors = {{1.0, "dor", true, "t.toml:3:4"}};
  for (const Failure& failure : {level_events(scenario).failure(), events_of(scenario).failure(),
                                 Simulation::create(scenario).failure()})
    EXPECT_EQ(failure.message, "t.toml:3:4: the scene has no object \"dor\"; did you mean \"door\"?");
}

TEST(LevelEvents, AnEventOutOfRangeNamesItsPosition) {
  Scenario scenario = two_rooms();
  scenario.timeline.blasts = {{0.5, {1, 1, 1}}};
  scenario.timeline.blasts[0].radius = 100;  // 500 voxels
  scenario.timeline.blasts[0].place = "t.toml:5:1";
  const auto events = events_of(scenario);
  ASSERT_FALSE(events);
  EXPECT_EQ(events.failure().code, ErrorCode::bad_input);
  EXPECT_EQ(events.failure().message.find("t.toml:5:1: blast at tick 32: expected "), 0u);
}

TEST(TickAt, TakesTheTickAtOrBefore) {
  EXPECT_EQ(tick_at(0.0, 64), 0u);
  EXPECT_EQ(tick_at(-3.0, 64), 0u);
  EXPECT_EQ(tick_at(1.0 / 64, 64), 1u);
  EXPECT_EQ(tick_at(0.99 / 64, 64), 0u);
  EXPECT_EQ(tick_at(0.1 + 0.2, 10), 3u);  // not rounded down to tick 2
  EXPECT_EQ(tick_at(3600.0, 1000), 3600000u);
}

}  // namespace
}  // namespace brume::scenario
