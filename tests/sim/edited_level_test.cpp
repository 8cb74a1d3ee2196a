#include "sim/edited_level.hpp"

#include <gtest/gtest.h>

#include <random>

#include "core/box.hpp"
namespace brume::sim {
namespace {

constexpr voxel::GridLayout kLayout{{21, 13, 18}, 0.5f, {0, 0, 0}};

/// A level as loaded, with or without glass and grilles.
struct Loaded {
  voxel::BitGrid grid{kLayout};
  voxel::RoleGrids roles;

  Loaded(std::mt19937& random, bool with_roles) {
    if (with_roles) roles = {voxel::BitGrid(kLayout), voxel::BitGrid(kLayout)};
    for_each_voxel([&](glm::ivec3 v) {
      const auto role = static_cast<Role>(random() % 4);
      grid.set(v, with_roles ? stops_smoke(role) : role == Role::wall);
      if (!with_roles) return;
      roles.sight->set(v, role == Role::wall);
      roles.bodies->set(v, stops_bodies(role));
    });
  }
  voxel::Solids solids() const { return {grid, roles}; }

  template <typename Visit>
  static void for_each_voxel(Visit visit) {
    for_each_in(Box<int>{glm::ivec3(0), kLayout.size}, visit);
  }
};

/// Some blocks, of which some reach out of the grid.
EditBlocks random_edits(std::mt19937& random) {
  EditBlocks edits;
  const glm::ivec3 blocks = (kLayout.size + 3) / 4;
  for_each_in(Box<int>{glm::ivec3(0), blocks}, [&](glm::ivec3 at) {
    if (random() % 3 != 0) return;
    EditBlock edit{.at = glm::i16vec3(at)};
    for (int bit = 0; bit < 64; ++bit) {
      std::uint64_t* const masks[] = {&edit.make_solid, &edit.make_free, &edit.make_glass, &edit.make_grille};
      if (const auto choice = random() % 6; choice < 4) *masks[choice] |= std::uint64_t{1} << bit;
    }
    edits.push_back(edit);
  });
  return edits;
}

void expect_roles(const voxel::Solids& a, const voxel::Solids& b) {
  int differences = 0;
  Loaded::for_each_voxel([&](glm::ivec3 v) { differences += a.role(v) != b.role(v); });
  EXPECT_EQ(differences, 0);
}

TEST(EditedLevel, ChangedEqualsRebuilt) {
  std::mt19937 random(17);
  for (const bool with_roles : {false, true}) {
    const Loaded loaded(random, with_roles);
    EditedLevel changed(loaded.solids());
    std::vector<std::shared_ptr<const EditBlocks>> before{nullptr};
    for (int i = 0; i < 60; ++i) {
      // Further edits, others, those of an earlier time, or none.
      if (i % 3 == 0)
        changed.add(random_edits(random));
      else if (i % 3 == 1)
        changed.replace(before[random() % before.size()]);
      else
        changed.replace(std::make_shared<const EditBlocks>(random_edits(random)));
      before.push_back(changed.edits());

      voxel::BitGrid grid = loaded.grid;
      voxel::RoleGrids roles = loaded.roles;
      if (changed.edits()) apply_edits(grid, roles, *changed.edits());
      expect_roles(changed.solids(), {grid, roles});
      EXPECT_EQ(&changed.grid(), &changed.solids().smoke);
    }
    changed.replace(nullptr);
    expect_roles(changed.solids(), loaded.solids());
  }
}

TEST(EditedLevel, CopiesNothingBeforeTheFirstEdit) {
  std::mt19937 random(3);
  const Loaded loaded(random, true);
  EditedLevel level(loaded.solids());
  level.replace(nullptr);
  level.replace(std::make_shared<const EditBlocks>());
  EXPECT_EQ(&level.grid(), &loaded.grid);
  EXPECT_EQ(&level.solids().sight, &*loaded.roles.sight);
  level.add(edit_box(kLayout, {0, 0, 0}, {1, 1, 1}, true));
  EXPECT_NE(&level.grid(), &loaded.grid);
}

TEST(EditBlocks, PairsHaveEachBlockOfBothListsOnce) {
  std::mt19937 random(9);
  for (int round = 0; round < 20; ++round) {
    EditBlocks a = random_edits(random), b = random_edits(random);
    if (round % 4 == 0) b = a;
    if (round % 5 == 0) a.clear();
    EditBlocks of_a, of_b;
    std::size_t pairs = 0, alike = 0, differences = 0;
    for_each_pair(a, b, [&](const EditBlock& x, const EditBlock& y) {
      EXPECT_EQ(x.at, y.at);
      if (x.all() != 0) of_a.push_back(x);
      if (y.all() != 0) of_b.push_back(y);
      ++pairs;
      alike += x == y;
    });
    for_each_difference(&a, &b, [&](const EditBlock& x, const EditBlock& y) {
      EXPECT_NE(x, y);
      ++differences;
    });
    EXPECT_EQ(differences, pairs - alike);
    EXPECT_EQ(of_a, a);
    EXPECT_EQ(of_b, b);
  }
}

}  // namespace
}  // namespace brume::sim
