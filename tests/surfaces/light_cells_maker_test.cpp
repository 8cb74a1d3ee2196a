#include "surfaces/light_cells_maker.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "core/same_bytes.hpp"
#include "tests/render/boxes.hpp"

namespace brume::surfaces {
namespace {

constexpr voxel::GridLayout kLayout{{12, 8, 8}, 0.5f, {-3, -2, -2}};

/// Two boxes, each an object.
scene::Scene two_boxes() {
  scene::Scene scene;
  render::add_box(scene.meshes.emplace_back(), {-2, -1, -1}, {-1, 1, 1});
  render::add_box(scene.meshes.emplace_back(), {1, -1, -1}, {2, 1, 1});
  scene.objects = {{"one", 0, scene::kNone, glm::mat4(1)}, {"other", 1, scene::kNone, glm::mat4(1)}};
  return scene;
}

/// The level without the second box, or with it.
std::shared_ptr<const planning::NextLevel> level_of(bool has_other) {
  voxel::BitGrid grid(kLayout);
  for_each_in({glm::ivec3(2, 2, 2), glm::ivec3(4, 6, 6)}, [&](glm::ivec3 v) { grid.set(v, true); });
  if (has_other)
    for_each_in({glm::ivec3(8, 2, 2), glm::ivec3(10, 6, 6)}, [&](glm::ivec3 v) { grid.set(v, true); });
  std::vector<std::uint32_t> hidden;
  if (!has_other) hidden.push_back(1);
  return std::make_shared<const planning::NextLevel>(planning::NextLevel{std::move(grid), std::move(hidden)});
}

planning::LevelState state_of(const planning::NextLevel& level) {
  planning::LevelState state;
  state.voxels.grid = &level.opaque;
  state.hidden_objects = level.hidden_objects;
  return state;
}

void expect_same(const LightCells& a, const LightCells& b) {
  EXPECT_TRUE(same_bytes(a.layout, b.layout));
  EXPECT_EQ(a.probes, b.probes);
  EXPECT_EQ(a.hits, b.hits);
  ASSERT_EQ(a.patches.size(), b.patches.size());
  for (std::size_t i = 0; i < a.patches.size(); ++i) EXPECT_TRUE(same_bytes(a.patches[i], b.patches[i])) << i;
}

class LightCellsMakerTest : public testing::Test {
 protected:
  /// The cells of a level, by a maker that expects nothing.
  LightCells made(const planning::LevelState& level) const { return LightCellsMaker(scene_).make(level); }

  const scene::Scene scene_ = two_boxes();
  const std::shared_ptr<const planning::NextLevel> with_ = level_of(true), without_ = level_of(false);
};

TEST_F(LightCellsMakerTest, ExpectedCellsAreTheSame) {
  LightCellsMaker maker(scene_);
  expect_same(maker.make(state_of(*with_)), made(state_of(*with_)));
  EXPECT_FALSE(maker.was_expected());
  maker.expect(without_);
  // Another grid of the same voxels.
  const auto same = level_of(false);
  expect_same(maker.make(state_of(*same)), made(state_of(*without_)));
  EXPECT_TRUE(maker.was_expected());
  EXPECT_NE(made(state_of(*with_)).hits, made(state_of(*without_)).hits);
}

TEST_F(LightCellsMakerTest, LevelsThatComeInsteadAreMadeAtOnce) {
  LightCellsMaker maker(scene_);
  maker.expect(without_);
  expect_same(maker.make(state_of(*with_)), made(state_of(*with_)));
  EXPECT_FALSE(maker.was_expected());
  expect_same(maker.make(state_of(*without_)), made(state_of(*without_)));
  EXPECT_TRUE(maker.was_expected()) << "still";
}

TEST_F(LightCellsMakerTest, WhatMovesAndFliesIsInNoCell) {
  scene::Scene scene = two_boxes();
  scene.grenade = scene.objects[0];
  planning::LevelState level = state_of(*without_);
  level.moved.push_back({1, glm::mat4(1)});
  level.grenades.push_back(glm::translate(glm::mat4(1), glm::vec3(1.5f, 0, 0)));
  LightCellsMaker maker(scene);
  maker.expect(without_);
  expect_same(maker.make(level), made(state_of(*without_)));
  EXPECT_TRUE(maker.was_expected());
  expect_same(maker.make(level), made(state_of(*without_)));
}

TEST_F(LightCellsMakerTest, NothingIsExpectedAfterTheLastChange) {
  LightCellsMaker maker(scene_);
  maker.expect(nullptr);
  expect_same(maker.make(state_of(*with_)), made(state_of(*with_)));
}

}  // namespace
}  // namespace brume::surfaces
