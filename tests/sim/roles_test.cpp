// Glass and grilles in the simulation: edits of them, and what lands where.
#include <gtest/gtest.h>

#include <random>

#include "core/box.hpp"
#include "sim/event_fields.hpp"
#include "sim/level_edit.hpp"
#include "sim/world.hpp"

namespace brume::sim {
namespace {

using glm::ivec3;
using voxel::BitGrid;
using voxel::RoleGrids;
using voxel::Solids;

/// A level, one role per voxel.
struct RoleLevel {
  explicit RoleLevel(const voxel::GridLayout& layout) : grid(layout) {}
  BitGrid grid;
  RoleGrids roles;

  Solids solids() const { return {grid, roles}; }
  void set(ivec3 v, Role role) {
    if (!roles.sight) roles = {grid, grid};
    grid.set(v, stops_smoke(role));
    roles.sight->set(v, stops_sight(role));
    roles.bodies->set(v, stops_bodies(role));
  }
};

RoleLevel random_level(const voxel::GridLayout& layout, unsigned seed) {
  std::mt19937 random(seed);
  RoleLevel level(layout);
  for_each_in(Box<int>{ivec3(0), layout.size},
              [&](ivec3 v) { level.set(v, static_cast<Role>(random() % 4)); });
  return level;
}

constexpr ivec3 kSizes[] = {ivec3(1), ivec3(7), ivec3(33, 17, 5), ivec3(8)};

void expect_same(const Solids& a, const Solids& b) {
  int differing = 0;
  for_each_in(Box<int>{ivec3(0), a.smoke.size()}, [&](ivec3 v) { differing += a.role(v) != b.role(v); });
  EXPECT_EQ(differing, 0);
}

TEST(RoleEdits, TheDifferenceTurnsOneLevelIntoAnother) {
  for (const ivec3 size : kSizes) {
    const voxel::GridLayout layout{size, 0.5f, glm::vec3(0)};
    const RoleLevel a = random_level(layout, 1), b = random_level(layout, 2);
    const EditBlocks edits = difference(a.solids(), b.solids(), ivec3(0), size);
    EXPECT_TRUE(check_event(LevelEdit{0, edits}, layout) || edits.empty());
    RoleLevel turned = a;
    apply_edits(turned.grid, turned.roles, edits);
    expect_same(turned.solids(), b.solids());
    EXPECT_TRUE(difference(b.solids(), turned.solids(), ivec3(0), size).empty());
    // Of what changes, all is effective once, and nothing the second time.
    EXPECT_EQ(effective_edits(a.solids(), edits), edits);
    EXPECT_TRUE(effective_edits(b.solids(), edits).empty());
  }
}

TEST(RoleEdits, MergedEditsAreOneAfterTheOther) {
  for (const ivec3 size : kSizes) {
    const voxel::GridLayout layout{size, 0.5f, glm::vec3(0)};
    const RoleLevel a = random_level(layout, 3), b = random_level(layout, 4), c = random_level(layout, 5);
    const EditBlocks first = difference(a.solids(), b.solids(), ivec3(0), size);
    const EditBlocks second = difference(b.solids(), c.solids(), ivec3(0), size);
    RoleLevel turned = a;
    apply_edits(turned.grid, turned.roles, merge_edits(first, second));
    expect_same(turned.solids(), c.solids());
  }
}

TEST(RoleEdits, TheContentOfABlockMakesItSo) {
  for (const ivec3 size : kSizes) {
    const voxel::GridLayout layout{size, 0.5f, glm::vec3(0)};
    const RoleLevel a = random_level(layout, 6), b = random_level(layout, 7);
    RoleLevel turned = b;
    for_each_in(Box<int>{ivec3(0), (size + 3) / 4}, [&](ivec3 block) {
      const EditBlock content = content_of(a.solids(), block);
      apply_edits(turned.grid, turned.roles, {&content, 1});
    });
    expect_same(turned.solids(), a.solids());
  }
}

TEST(RoleEdits, OfWallsAloneNeedNoOtherGrid) {
  const voxel::GridLayout layout{ivec3(9, 5, 7), 0.5f, glm::vec3(0)};
  RoleLevel level(layout);
  apply_edits(level.grid, level.roles, edit_box(layout, ivec3(1), ivec3(4), true));
  EXPECT_TRUE(level.roles.empty());
  const EditBlock pane{glm::i16vec3(0), 0, 0, 1, 0};
  apply_edits(level.grid, level.roles, {&pane, 1});
  EXPECT_TRUE(level.roles.sight);
  EXPECT_FALSE(level.roles.bodies);
  EXPECT_EQ(level.solids().role(ivec3(0)), Role::glass);
  EXPECT_EQ(level.solids().role(ivec3(2)), Role::wall);
}

TEST(RoleEdits, AVoxelHasOneRole) {
  const voxel::GridLayout layout{ivec3(8), 0.5f, glm::vec3(0)};
  for (const EditBlock& block :
       {EditBlock{glm::i16vec3(0), 1, 0, 1, 0}, EditBlock{glm::i16vec3(0), 0, 2, 0, 2},
        EditBlock{glm::i16vec3(0), 0, 0, 4, 4}, EditBlock{}})
    EXPECT_FALSE(check_event(LevelEdit{0, {block}}, layout));
  EXPECT_TRUE(check_event(LevelEdit{0, {{glm::i16vec3(0), 1, 2, 4, 8}}}, layout));
}

/// A corridor of 12 x 4 x 4 m along x, closed, with a floor; what is across it at x = 6 m has a role.
RoleLevel corridor(Role role) {
  RoleLevel level({{24, 8, 8}, 0.5f, glm::vec3(0)});
  for_each_in(Box<int>{ivec3(0), {24, 8, 8}}, [&](ivec3 v) {
    const bool shell = v.x == 0 || v.y == 0 || v.z == 0 || v.x == 23 || v.y == 7 || v.z == 7;
    level.set(v, shell ? Role::wall : v.x == 12 ? role : Role::ghost);
  });
  return level;
}

Position place_at(double x, double y, double z) {
  return position_from_metres({x, y, z});
}

/// The world of a corridor after a throw along it, when the smoke has grown.
World thrown(const RoleLevel& level) {
  World world(level.solids());
  world.append(ThrowSmoke{0, place_at(2, 1.7, 2.2), place_at(11, 1.7, 2.2), {600}}).value_or_throw();
  world.advance_to(200);
  return world;
}

bool any_smoke(const World& world, int from_x, int to_x) {
  bool any = false;
  for_each_in(Box<int>{{from_x, 0, 0}, {to_x, 8, 8}}, [&](ivec3 v) { any |= world.state().density(v) > 0; });
  return any;
}

TEST(Roles, OfWhatIsInTheWayOfAGrenadeAndOfItsSmoke) {
  struct Case {
    Role role;
    int lands_at;       // x of the voxel
    bool smoke_behind;  // and before
  };
  for (const Case& c : {Case{Role::wall, 11, false}, Case{Role::glass, 11, false},
                        Case{Role::grille, 11, true}, Case{Role::ghost, 22, true}}) {
    const RoleLevel level = corridor(c.role);
    const World world = thrown(level);
    ASSERT_EQ(world.state().clouds.size(), 1u) << name_of(c.role);
    EXPECT_EQ(world.state().clouds[0].cloud->origin().source.x, c.lands_at) << name_of(c.role);
    EXPECT_EQ(any_smoke(world, 13, 24), c.smoke_behind) << name_of(c.role);
    EXPECT_EQ(any_smoke(world, 12, 13), c.smoke_behind) << "in the voxels of a grille is smoke";
  }
}

// The depth of a shot's hole ends in glass, and passes a grille.
TEST(Roles, ShotsPassGrilles) {
  const auto depth = [](Role role) {
    const RoleLevel level = corridor(role);
    World world = thrown(level);
    world.append(Shot{200, place_at(1, 1.7, 2.2), place_at(2, 1.7, 2.2), 205, {}}).value_or_throw();
    return world.state().holes.empty() ? 0 : static_cast<double>(world.state().holes[0].distance) / 1024;
  };
  // To the middle of the voxel at 6 m.
  EXPECT_NEAR(depth(Role::wall), 5.25, 0.01);
  EXPECT_NEAR(depth(Role::glass), 5.25, 0.01);
  EXPECT_GT(depth(Role::grille), 6);
}

// A pane breaks, a wall is built across the gap, and all of it is undone by going back.
TEST(Roles, EditsKeepTheGridsRightInAnyOrderOfTicks) {
  const RoleLevel level = corridor(Role::glass);
  World world(level.solids());
  const ivec3 low{12, 1, 1}, high{13, 7, 7}, middle(12, 3, 3);
  const voxel::GridLayout layout = level.grid.layout();
  EditBlocks to_grille = edit_box(layout, low, high, true);
  for (EditBlock& block : to_grille) block = {block.at, 0, 0, 0, block.make_solid};
  EditBlocks to_glass = edit_box(layout, low, high, true);
  for (EditBlock& block : to_glass) block = {block.at, 0, 0, block.make_solid, 0};
  world.append(LevelEdit{10, edit_box(layout, low, high, false)}).value_or_throw();
  world.append(LevelEdit{20, edit_box(layout, low, high, true)}).value_or_throw();
  world.append(LevelEdit{30, to_grille}).value_or_throw();
  world.append(LevelEdit{40, to_glass}).value_or_throw();
  const Role expected[] = {Role::glass, Role::ghost, Role::wall, Role::grille, Role::glass};
  for (const unsigned step : {0u, 1u, 2u, 3u, 4u, 2u, 4u, 1u, 3u, 0u, 4u, 0u, 2u}) {
    world.advance_to(10 * step + 5);
    EXPECT_EQ(world.solids().role(middle), expected[step]) << step;
    EXPECT_EQ(world.solids().role({0, 3, 3}), Role::wall) << step;
  }
  // A wall in the place of glass is a change, although smoke notices nothing.
  World bricked(level.solids());
  bricked.append(LevelEdit{10, edit_box(layout, low, high, true)}).value_or_throw();
  bricked.advance_to(10);
  ASSERT_TRUE(bricked.state().edits);
  EXPECT_EQ(bricked.solids().role(middle), Role::wall);
  World restored(level.solids());
  restored.restore(bricked.state()).value_or_throw();
  EXPECT_EQ(restored.solids().role(middle), Role::wall);
}

// A cloud flows again where the level changes for smoke, and only there.
TEST(Roles, ACloudIsTheSameBesideAPaneThatBecomesAWall) {
  const RoleLevel level = corridor(Role::glass);
  World world = thrown(level);
  const auto cloud = world.state().clouds[0].cloud;
  world.append(LevelEdit{201, edit_box(level.grid.layout(), {12, 1, 1}, {13, 7, 7}, true)}).value_or_throw();
  world.advance_to(201);
  EXPECT_EQ(world.state().clouds[0].cloud, cloud);
  world.append(LevelEdit{202, edit_box(level.grid.layout(), {12, 1, 1}, {13, 7, 7}, false)}).value_or_throw();
  world.advance_to(202);
  EXPECT_NE(world.state().clouds[0].cloud, cloud);
}

TEST(Roles, StatesOfOtherRolesHaveOtherHashes) {
  State state;
  const auto hash = [&](EditBlock block) {
    state.edits = std::make_shared<const EditBlocks>(EditBlocks{block});
    return state.hash();
  };
  const std::uint64_t glass = hash({glm::i16vec3(0), 0, 0, 1, 0}),
                      grille = hash({glm::i16vec3(0), 0, 0, 0, 1}), wall = hash({glm::i16vec3(0), 1, 0}),
                      free = hash({glm::i16vec3(0), 0, 1});
  EXPECT_NE(glass, grille);
  EXPECT_NE(glass, wall);
  EXPECT_NE(grille, free);
}

}  // namespace
}  // namespace brume::sim
