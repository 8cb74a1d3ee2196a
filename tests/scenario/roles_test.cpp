// Roles of a scene's objects in its level: voxels, cache, doors and sight.
#include <gtest/gtest.h>

#include "core/file.hpp"
#include "scenario/aim.hpp"
#include "scenario/editable_scenario.hpp"
#include "scenario/walker.hpp"
#include "scenario/world_triangles.hpp"
#include "smoke/holes.hpp"
#include "smoke/sight.hpp"
#include "tests/scenario/two_rooms.hpp"
#include "tests/work_folder.hpp"
#include "voxel/voxelize.hpp"

namespace brume::scenario {
namespace {

using glm::ivec3;
using glm::vec3;

constexpr float kWalls = std::numeric_limits<float>::infinity();

/// The two rooms with a door of a role.
Scenario rooms_with_door(Role role) {
  Scenario scenario = two_rooms();
  for (scene::Object& object : scenario.scene.objects)
    if (object.name == "door") object.role = role;
  scenario.voxels = load_or_voxelize(scenario.scene, scenario.voxels.grid.layout(), {}).value_or_throw();
  return scenario;
}

/// By definition: the role that stops most of all shown objects that touch the voxel.
void expect_role_of_objects(const voxel::Solids& solids, const scene::Scene& scene,
                            std::span<const std::uint32_t> hidden) {
  voxel::TrianglesByRole triangles;
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i)
    if (std::ranges::find(hidden, i) == hidden.end())
      triangles.add(scene.objects[i].role, object_triangles(scene, scene.objects[i]));
  const voxel::BitGrid grid = voxel::voxelize(triangles.smoke, solids.smoke.layout()).value_or_throw();
  const voxel::RoleGrids roles = voxel::voxelize_roles(triangles, grid).value_or_throw();
  const voxel::Solids expected(grid, roles);
  int differing = 0;
  for_each_in(Box<int>{ivec3(0), grid.size()},
              [&](ivec3 v) { differing += solids.role(v) != expected.role(v); });
  EXPECT_EQ(differing, 0);
}

bool sees(const Simulation& simulation, vec3 a, vec3 b) {
  const sim::State& state = simulation.world().state();
  const std::vector<shared::Hole> holes = smoke::make_holes(state);
  const smoke::Sight sight(simulation.volume(), simulation.world().solids().sight, holes,
                           state.seconds(state.tick));
  return sight.visible(a, b, kWalls).value_or_throw();
}

bool smoke_in_east(const Simulation& simulation) {
  const sim::State& state = simulation.world().state();
  bool any = false;
  for_each_in(Box<int>{{24, 3, 4}, {40, 15, 24}}, [&](ivec3 v) { any |= state.density(v) > 0; });
  return any;
}

TEST(Roles, ADoorOfEachRole) {
  const vec3 west(-2, 1, 0.1f), east(2, 1, 0.1f);
  for (const Role role : {Role::wall, Role::glass, Role::grille, Role::ghost}) {
    Scenario scenario = rooms_with_door(role);
    scenario.timeline.doors = {{5, "door", true, ""}, {8, "door", false, ""}};
    const auto simulation = Simulation::create(scenario).value_or_throw();
    const std::string name = name_of(role);
    for (const double time : {4.0, 6.0, 9.0, 4.5, 6.5}) {
      simulation->advance_to(time);
      const bool open = time > 5 && time < 8;
      EXPECT_EQ(sees(*simulation, west, east), open || !stops_sight(role)) << name << " at " << time;
      if (time == 4) {
        EXPECT_EQ(smoke_in_east(*simulation), !stops_smoke(role)) << name;
      }
      expect_role_of_objects(simulation->world().solids(), scenario.scene, simulation->hidden_objects());
    }
  }
}

// Edits are walls or nothing, whatever was there; saved and loaded again, the timeline gives the same states.
TEST(Roles, EditsOfALivingScenario) {
  for (const Role role : {Role::glass, Role::grille}) {
    auto live = EditableScenario::create(rooms_with_door(role)).value_or_throw();
    live->advance_to(3);
    const vec3 low(-0.2f, 0.4f, -0.4f), high(0.2f, 1, 0.4f);
    const auto role_there = [&] {
      const voxel::Solids solids = live->simulation().world().solids();
      return solids.role(ivec3(glm::floor(voxel_from_world(solids.smoke.layout(), vec3(0, 0.7f, 0)))));
    };
    EXPECT_EQ(role_there(), role);
    scene::Timeline actions;
    actions.edits = {{1, low, high, true}, {2, low, high, false}};
    live->add(actions).value_or_throw();
    live->advance_to(1);
    EXPECT_EQ(role_there(), Role::wall);
    live->advance_to(2.5);
    EXPECT_EQ(role_there(), Role::ghost);
    actions.edits.clear();
    actions.doors = {{3, "door", true, ""}, {4, "door", false, ""}};
    live->add(actions).value_or_throw();
    live->advance_to(3.5);
    EXPECT_EQ(role_there(), Role::ghost);
    live->advance_to(4.5);
    EXPECT_EQ(role_there(), role) << "a door that is shown again lies above the edit";

    Scenario again = rooms_with_door(role);
    again.timeline = live->scenario().timeline;
    const auto loaded = Simulation::create(again).value_or_throw();
    for (const double time : {0.5, 1.5, 2.5, 3.5, 4.5}) {
      live->advance_to(time);
      loaded->advance_to(time);
      EXPECT_EQ(live->simulation().world().state_hash(), loaded->world().state_hash()) << time;
    }
  }
}

TEST(Roles, ATimelineCannotBeResetToOtherRoles) {
  auto live = EditableScenario::create(rooms_with_door(Role::glass)).value_or_throw();
  scene::Timeline timeline = live->scenario().timeline;
  timeline.roles = {{"door", Role::wall}};
  const auto done = live->reset(timeline);
  ASSERT_FALSE(done);
  EXPECT_NE(done.failure().message.find("roles"), std::string::npos) << done.failure().message;
}

TEST(Roles, BodiesStopAtAGrilleAndAimsPassIt) {
  const Scenario grille = rooms_with_door(Role::grille), glass = rooms_with_door(Role::glass);
  const auto walked_to = [](const Scenario& scenario) {
    const voxel::BitGrid& bodies = scenario.voxels.solids().bodies;
    Walker walker;
    walker.put(bodies, vec3(-2, 1.7f, 0));
    WalkerInput input;
    input.direction_world = vec3(1, 0, 0);
    for (int i = 0; i < 200; ++i) walker.move(bodies, input, 0.02);
    return walker.eye_world().x;
  };
  EXPECT_LT(walked_to(grille), 0);
  EXPECT_LT(walked_to(glass), 0);
  EXPECT_GT(walked_to(rooms_with_door(Role::ghost)), 0.5f);
  // Shots pass the grille to the far wall; a thrown grenade does not.
  const vec3 eye(-2, 1, 0.1f), ahead(1, 0, 0);
  EXPECT_GT(aim(grille.voxels.grid, eye, ahead).meets.value(), 5);
  EXPECT_LT(aim(glass.voxels.grid, eye, ahead).meets.value(), 2.5f);
  EXPECT_LT(aim(grille.voxels.solids().bodies, eye, ahead).landing_world.value().x, 0);
}

TEST(Roles, TheCacheHasThemAndItsKeyDependsOnThem) {
  const cli::WorkFolder folder;
  const auto path = folder.path() / "rooms.vxl";
  const voxel::GridLayout layout = two_rooms().voxels.grid.layout();
  for (const Role role : {Role::wall, Role::glass, Role::grille, Role::ghost, Role::glass}) {
    const Scenario scenario = rooms_with_door(role);
    const Voxels made = load_or_voxelize(scenario.scene, layout, path).value_or_throw();
    EXPECT_FALSE(made.cached) << name_of(role);
    const Voxels read = load_or_voxelize(scenario.scene, layout, path).value_or_throw();
    EXPECT_TRUE(read.cached) << name_of(role);
    expect_role_of_objects(read.solids(), scenario.scene, {});
  }
}

TEST(Roles, TrianglesOfALevelByRole) {
  const Scenario scenario = rooms_with_door(Role::glass);
  const voxel::TrianglesByRole triangles = triangles_by_role(scenario.scene);
  EXPECT_EQ(triangles.smoke, world_triangles(scenario.scene));
  ASSERT_TRUE(triangles.walls);
  EXPECT_EQ(triangles.smoke.size() - triangles.walls->size(), 24u) << "two leaves of twelve";
  EXPECT_TRUE(triangles.grilles.empty());
  voxel::TrianglesByRole one_by_one;
  for (const scene::Object& object : scenario.scene.objects)
    one_by_one.add(object.role, object_triangles(scenario.scene, object));
  EXPECT_EQ(one_by_one.smoke, triangles.smoke);
  EXPECT_EQ(one_by_one.walls, triangles.walls);
}

}  // namespace
}  // namespace brume::scenario
