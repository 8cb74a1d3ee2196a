#include "planning/noise_updates.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "planning/smoke_visibility.hpp"
#include "tests/worlds.hpp"

namespace brume::planning {
namespace {

/// Two smokes that have stopped growing.
class NoiseUpdatesTest : public ::testing::Test {
 protected:
  static constexpr float kVoxel = Yard::kVoxel;

  NoiseUpdatesTest() {
    inputs_.volume = &volume_;
    inputs_.slots = visibility_.slots;
    inputs_.motions = motions_;
    inputs_.time = 10;
  }
  std::set<std::uint32_t> due() {
    const std::set<std::uint32_t> due = planned();
    updates_.commit();
    return due;
  }
  std::set<std::uint32_t> planned() {
    const auto due = updates_.slots_due(inputs_);
    EXPECT_TRUE(std::is_sorted(due.begin(), due.end()));
    return {due.begin(), due.end()};
  }
  std::set<std::uint32_t> all() const { return {visibility_.slots.begin(), visibility_.slots.end()}; }

  static const smoke::SmokeVolume& volume() {
    static const Yard kYard({8, 30}, 3000, 700);
    return kYard.volume;
  }
  const smoke::SmokeVolume& volume_ = volume();
  SmokeVisibility visibility_ = all_smoke_visible(volume_);
  std::vector<shared::CloudMotion> motions_ = std::vector<shared::CloudMotion>(2, shared::CloudMotion{});
  NoiseInputs inputs_;
  NoiseUpdates updates_;
};

TEST_F(NoiseUpdatesTest, EveryBrickIsDueInFourFramesAndNoneWhileTimeStandsStill) {
  EXPECT_EQ(due(), all());
  EXPECT_TRUE(due().empty()) << "the same time again";
  std::map<std::uint32_t, int> last;
  for (const std::uint32_t slot : visibility_.slots) last[slot] = 0;
  for (int frame = 1; frame < 30; ++frame) {
    inputs_.time += 0.1f;
    const auto now = due();
    EXPECT_LE(now.size(), (all().size() + 3) / 4 + 1);
    for (const std::uint32_t slot : now) last[slot] = frame;
    for (const auto& [slot, when] : last) EXPECT_LE(frame - when, 4);
  }
  // What was not due yet at this time, and nothing more.
  inputs_.time += 0.1f;
  const auto first = due();
  const auto rest = due();
  std::set<std::uint32_t> both = first;
  both.insert(rest.begin(), rest.end());
  EXPECT_FALSE(rest.empty());
  EXPECT_EQ(both, all());
  EXPECT_TRUE(due().empty());
}

TEST_F(NoiseUpdatesTest, WhatMovesOrIsNewIsNeverLate) {
  due();
  // An impulse through the first smoke, in the frames that have it and in the one after.
  shared::Impulse impulse{};
  impulse.from_world = {2, 1, 8};
  impulse.to_world = {14, 1, 8};
  impulse.radius = 0.5f;
  const std::vector<shared::Impulse> impulses{impulse};
  std::set<std::uint32_t> near;
  for (const std::uint32_t slot : visibility_.slots) {
    const glm::vec3 low = 8 * kVoxel * glm::vec3(volume_.brick_of(slot));
    const glm::vec3 closest = glm::clamp(glm::vec3(8, 1, 8), low, low + 8 * kVoxel);
    if (std::abs(closest.y - 1) < 0.5f && std::abs(closest.z - 8) < 0.5f && low.x < 14) near.insert(slot);
  }
  ASSERT_FALSE(near.empty());
  const auto expect_near = [&] {
    const auto now = due();
    EXPECT_TRUE(std::includes(now.begin(), now.end(), near.begin(), near.end()));
    EXPECT_LT(now.size(), all().size());
  };
  inputs_.impulses = impulses;
  expect_near();
  EXPECT_TRUE(due().empty()) << "it stands";
  inputs_.impulses = {};
  expect_near();
  EXPECT_TRUE(due().empty());
  // Out of view and back.
  const std::vector<std::uint32_t> some(visibility_.slots.begin(), visibility_.slots.begin() + 3);
  inputs_.slots = some;
  due();
  inputs_.slots = visibility_.slots;
  std::set<std::uint32_t> back = all();
  for (const std::uint32_t slot : some) back.erase(slot);
  EXPECT_EQ(due(), back);
  // A cloud that blooms.
  motions_[1].front += 0.1f;
  EXPECT_EQ(due(), all());
  // Another look, and frames in between that did not slice.
  inputs_.look.swirl = 1;
  EXPECT_EQ(due(), all());
  updates_.skip_frame();
  updates_.commit();
  EXPECT_EQ(due(), all());
  updates_.invalidate();
  EXPECT_EQ(due(), all());
}

TEST_F(NoiseUpdatesTest, AFrameThatIsNotCommittedIsPlannedAgain) {
  EXPECT_EQ(planned(), all());
  EXPECT_EQ(due(), all());
  inputs_.time += 0.1f;
  const std::set<std::uint32_t> quarter = planned();
  EXPECT_LT(quarter.size(), all().size());
  EXPECT_EQ(planned(), quarter);
  updates_.skip_frame();
  EXPECT_EQ(due(), quarter);
  inputs_.time += 0.1f;
  EXPECT_NE(due(), quarter);
}

}  // namespace
}  // namespace brume::planning
