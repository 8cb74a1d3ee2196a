#include "planning/smoke_light_cache.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <utility>

#include "planning/view_frustum.hpp"
#include "tests/worlds.hpp"

namespace brume::planning {
namespace {

/// The plan of a frame that is drawn.
SmokeLightPlan planned(SmokeLightCache&& cache, const SmokeLightInputs& inputs) {
  return cache.plan(inputs);
}
const SmokeLightPlan& planned(SmokeLightCache& cache, const SmokeLightInputs& inputs) {
  const SmokeLightPlan& plan = cache.plan(inputs);
  cache.commit();
  return plan;
}

/// Three smokes, lights between.
class SmokeLightCacheTest : public ::testing::Test {
 protected:
  static constexpr float kVoxel = Yard::kVoxel;

  SmokeLightCacheTest() {
    for (int i = 0; i < 9; ++i)
      lights_.push_back(point_light({4.5f * static_cast<float>(i), 2, 4}, glm::vec3(1), 0));
  }
  SmokeLightInputs inputs() const {
    SmokeLightInputs inputs;
    inputs.volume = &volume_;
    inputs.visibility = &visibility_;
    inputs.lights = lights_;
    inputs.holes = holes_;
    inputs.time = 1.5f;
    return inputs;
  }

  Yard yard_{{6, 20, 34}, 400, 90};
  const smoke::SmokeVolume& volume_ = yard_.volume;
  const SmokeVisibility visibility_ = all_smoke_visible(volume_);
  std::vector<shared::Light> lights_;
  std::vector<shared::Hole> holes_;
};

TEST_F(SmokeLightCacheTest, APlanReliesOnNothingOfOneThatWasNotDrawn) {
  SmokeLightCache cache;
  const std::size_t all = cache.plan(inputs()).shadow_rays.size();
  EXPECT_EQ(planned(cache, inputs()).shadow_rays.size(), all);
  EXPECT_TRUE(planned(cache, inputs()).parts.empty());
  lights_.push_back(lights_.front());
  lights_.back().position_world.x += 1;
  const SmokeLightPlan dropped = cache.plan(inputs());
  EXPECT_FALSE(dropped.parts.empty());
  EXPECT_GE(planned(cache, inputs()).shadow_rays.size(), dropped.shadow_rays.size());
  EXPECT_TRUE(planned(cache, inputs()).parts.empty());
}

TEST_F(SmokeLightCacheTest, WhatTheDeviceHasNoRoomForIsPlannedFromTheStart) {
  SmokeLightCache cache;
  const SmokeLightPlan first = planned(cache, inputs());
  const SmokeLightRoom held{first.texel_list_count, first.page_count};
  SmokeLightInputs more = inputs();
  more.room = held;
  EXPECT_TRUE(planned(cache, more).parts.empty());
  // A light more takes pages that the device has to make, and loses the others for.
  lights_.push_back(lights_.front());
  lights_.back().position_world.x += 1;
  more = inputs();
  more.room = held;
  const SmokeLightPlan grown = planned(cache, more);
  EXPECT_GT(grown.page_count, held.pages);
  EXPECT_EQ(grown.shadow_rays.size(), planned(SmokeLightCache(), inputs()).shadow_rays.size());
  // With room for it the others stay.
  SmokeLightCache roomy;
  lights_.pop_back();
  planned(roomy, inputs());
  lights_.push_back(lights_.front());
  lights_.back().position_world.x += 1;
  EXPECT_LT(planned(roomy, inputs()).shadow_rays.size(), grown.shadow_rays.size());
}

TEST_F(SmokeLightCacheTest, FollowsEveryLightOfEveryBrickOnceAndThenNothing) {
  SmokeLightCache cache;
  const SmokeLightPlan first = planned(cache, inputs());
  ASSERT_EQ(first.parts.size(), 1u);
  EXPECT_EQ(first.gathers.size(), visibility_.visible_count);
  EXPECT_EQ(first.texel_lists.size(), visibility_.visible_count);
  std::set<std::uint32_t> blocks;
  for (const shared::ShadowRays& rays : first.shadow_rays) EXPECT_TRUE(blocks.insert(rays.block).second);
  EXPECT_EQ(blocks.size(), first.page_count);
  // Every point of a brick within the range of a light has that light.
  const shared::VolumeLayout& layout = volume_.layout();
  for (const shared::LightGather& brick : first.gathers)
    for (std::uint32_t light = 0; light < lights_.size(); ++light) {
      const glm::vec3 low =
          layout.origin_world + kVoxel * (8.0f * glm::vec3(volume_.brick_of(brick.slot)) - 0.5f);
      const glm::vec3 near = glm::clamp(lights_[light].position_world, low, low + 9 * kVoxel);
      if (glm::distance(near, lights_[light].position_world) >= lights_[light].range) continue;
      bool listed = false;
      for (std::uint32_t i = 0; i < brick.light_count; ++i)
        listed |= first.gathered_lights[brick.first_light + i].x == light;
      EXPECT_TRUE(listed);
    }
  const SmokeLightPlan again = planned(cache, inputs());
  EXPECT_TRUE(again.parts.empty() && again.shadow_rays.empty() && again.gathers.empty());
}

TEST_F(SmokeLightCacheTest, WhatDoesNotFitIsDoneInParts) {
  const std::size_t all = planned(SmokeLightCache(), inputs()).shadow_rays.size();
  const auto most = static_cast<std::uint32_t>(all / 3);
  SmokeLightCache cache(most);
  for (int repeat = 0; repeat < 2; ++repeat) {
    const SmokeLightPlan plan = planned(cache, inputs());
    EXPECT_GT(plan.parts.size(), 2u);
    EXPECT_LE(plan.page_count, most);
    EXPECT_EQ(plan.shadow_rays.size(), all);
    std::size_t pairs = 0;
    std::set<std::uint32_t> slots;
    for (const SmokeLightPlan::Part& part : plan.parts) {
      EXPECT_EQ(part.shadow_rays.first, pairs);
      pairs += part.shadow_rays.count;
      std::set<std::uint32_t> blocks;
      for (std::uint32_t i = 0; i < part.shadow_rays.count; ++i)
        EXPECT_TRUE(blocks.insert(plan.shadow_rays[part.shadow_rays.first + i].block).second);
      for (std::uint32_t i = 0; i < part.gathers.count; ++i)
        EXPECT_TRUE(slots.insert(plan.gathers[part.gathers.first + i].slot).second);
    }
    EXPECT_EQ(pairs, all);
    EXPECT_EQ(slots.size(), visibility_.visible_count);
  }
}

TEST_F(SmokeLightCacheTest, AHoleInvalidatesOnlyTheRaysThatMayCrossIt) {
  SmokeLightCache cache;
  const std::size_t all = planned(cache, inputs()).shadow_rays.size();
  // Along z through the first smoke; the last is 28 m away, and no light reaches from there to here.
  holes_ = {open_hole({6, 1, 4}, {0, 0, 1}, 0.2f, 8, 1)};
  const SmokeLightPlan plan = planned(cache, inputs());
  EXPECT_GT(plan.shadow_rays.size(), 0u);
  EXPECT_LT(plan.shadow_rays.size(), all);
  // The rays to all lights from the smoke that it goes through.
  const auto in_first = [&](std::uint32_t slot) {
    return static_cast<float>(8 * volume_.brick_of(slot).x) * kVoxel < 12;
  };
  const SmokeLightPlan whole = planned(SmokeLightCache(), inputs());
  std::multiset<std::uint32_t> lights, whole_lights;
  for (const auto& rays : plan.shadow_rays)
    if (volume_.brick_of(rays.slot) == glm::ivec3(1, 0, 2)) lights.insert(rays.light);
  for (const auto& rays : whole.shadow_rays)
    if (volume_.brick_of(rays.slot) == glm::ivec3(1, 0, 2)) whole_lights.insert(rays.light);
  EXPECT_FALSE(whole_lights.empty());
  EXPECT_EQ(lights, whole_lights);
  bool far_light = false;
  for (const auto& rays : plan.shadow_rays) far_light |= !in_first(rays.slot) && rays.light == 8;
  EXPECT_FALSE(far_light);
}

/// When each phase of each brick was updated by all of its rays, according to plans.
class Ages {
 public:
  /// Takes a frame's plan; how many pages of rays it follows, those of some phases as fractions.
  double take(const SmokeLightPlan& plan, std::uint32_t frame) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> times;  // of (slot, phase)
    for (const shared::ShadowRays& rays : plan.shadow_rays) {
      if (rays.texels == shared::kNewTexels) continue;
      for (std::uint32_t phase = rays.texels & 255; phase < rays.texels >> 8; ++phase)
        ++times[{rays.slot, phase}];
      followed_ += (rays.texels >> 8) - (rays.texels & 255);
    }
    for (const shared::LightGather& brick : plan.gathers) {
      if (brick.texels == shared::kNewTexels) continue;
      for (std::uint32_t phase = brick.texels & 255; phase < brick.texels >> 8; ++phase)
        if (times[{brick.slot, phase}] == brick.light_count + shared::kSkyPages)
          updated_[{brick.slot, phase}] = frame;
    }
    return static_cast<double>(std::exchange(followed_, 0)) / shared::kLightPhases;
  }
  std::uint32_t oldest(std::uint32_t frame) const {
    std::uint32_t oldest = 0;
    for (const auto& [what, made] : updated_) oldest = std::max(oldest, frame - made);
    return oldest;
  }
  std::uint32_t oldest_of(std::uint32_t slot, std::uint32_t frame) const {
    std::uint32_t oldest = 0;
    for (std::uint32_t phase = 0; phase < shared::kLightPhases; ++phase)
      oldest = std::max(oldest, frame - updated_.at({slot, phase}));
    return oldest;
  }
  std::size_t size() const { return updated_.size(); }

 private:
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> updated_;
  std::uint64_t followed_ = 0;
};

TEST_F(SmokeLightCacheTest, AnUpdateFractionUpdatesEveryPhaseInTime) {
  for (const float fraction : {0.5f, 0.3f, 0.25f, 0.125f, 0.0625f, 0.01f}) {
    SmokeLightCache cache;
    Ages ages;
    SmokeLightInputs now = inputs();
    now.look.erosion = 0.5f;
    now.update_fraction = fraction;
    const double all = ages.take(planned(cache, now), 0);
    EXPECT_EQ(ages.size(), visibility_.visible_count * shared::kLightPhases) << "at first all is updated";
    // What there is of it: 1/2, 1/4, ... 1/16.
    const double part = std::max(std::exp2(std::floor(std::log2(double{fraction}))), 1.0 / 16);
    const double more = std::max(std::exp2(std::ceil(std::log2(double{fraction}))), 1.0 / 16);
    std::uint32_t oldest = 0;
    for (std::uint32_t frame = 1; frame < 100; ++frame) {
      now.time += 0.01f;
      now.viewpoint.x += 0.1f;
      const double followed = ages.take(planned(cache, now), frame);
      oldest = std::max(oldest, ages.oldest(frame));
      // Every brick was new in the first frame, and is updated four times as fast until all of it was.
      if (frame < 4) continue;
      EXPECT_GE(followed, part * all);
      EXPECT_LE(followed, more * all);
    }
    EXPECT_LE(oldest, std::ceil(1 / std::max(fraction, 1.0f / 16)) + 1);
    EXPECT_GT(oldest, 0u);
    // And then nothing happens.
    const auto left = static_cast<int>(std::ceil(1 / std::max(fraction, 1.0f / 16)));
    for (int i = 0; i < left; ++i) planned(cache, now);
    EXPECT_TRUE(planned(cache, now).parts.empty());
  }
}

TEST_F(SmokeLightCacheTest, BricksWhoseSmokeChangesAreUpdatedTwiceAsFast) {
  SmokeLightCache cache;
  Ages ages;
  SmokeLightInputs now = inputs();
  now.look.erosion = 0.5f;
  now.update_fraction = 1.0f / shared::kLightPhases;
  std::uint32_t frame = 0;
  const auto draw = [&] {
    now.time += 0.01f;
    const SmokeLightPlan& plan = planned(cache, now);
    ages.take(plan, frame++);
    return plan.texel_lists;
  };
  for (int i = 0; i < 40; ++i) draw();

  // An explosion in the first smoke, which refills for seconds.
  yard_.append(sim::Blast{.tick = 91, .at = sim::position_from_metres({6, 1, 8}), .radius = 2 * 1024});
  std::map<std::uint32_t, std::uint32_t> changing;  // slot: frames in a row
  std::uint32_t of_changing = 0, of_others = 0;
  for (std::uint32_t tick = 91; tick < 160; ++tick) {
    yard_.advance_to(tick);
    std::map<std::uint32_t, std::uint32_t> changed;
    for (const shared::TexelList& list : draw()) changed[list.slot] = changing[list.slot] + 1;
    changing = std::move(changed);
    for (std::uint32_t i = 0; i < visibility_.visible_count; ++i) {
      const std::uint32_t slot = visibility_.slots[i];
      const auto found = changing.find(slot);
      const std::uint32_t oldest = ages.oldest_of(slot, frame - 1);
      if (found == changing.end()) of_others = std::max(of_others, oldest);
      if (found != changing.end() && found->second > shared::kLightPhases)
        of_changing = std::max(of_changing, oldest);
    }
  }
  EXPECT_GT(of_changing, 0u);
  EXPECT_LE(of_changing, shared::kLightPhases / 2);
  EXPECT_GT(of_others, shared::kLightPhases / 2);
  EXPECT_LE(of_others, shared::kLightPhases);
}

TEST_F(SmokeLightCacheTest, TexelsSideBySideAreOfOtherPhasesAndBricksAgreeOnThem) {
  std::array<std::uint32_t, shared::kLightPhases> texels{};
  for (std::uint32_t i = 0; i < shared::kTexelsPerBrick; ++i) {
    const glm::uvec3 texel(i % 10, i / 10 % 10, i / 100);
    const std::uint32_t phase = shared::light_phase(texel);
    ASSERT_LT(phase, shared::kLightPhases);
    ++texels[phase];
    for (int axis = 0; axis < 3; ++axis) {
      glm::uvec3 beside = texel;
      beside[axis] += 1;
      // In the other half, so that it is never updated in the same frame.
      EXPECT_NE(shared::light_phase(beside) >> 3, phase >> 3);
      // The same voxel in the next brick.
      beside[axis] = texel[axis] + shared::kBrickVoxels;
      EXPECT_EQ(shared::light_phase(beside), phase);
    }
  }
  for (const std::uint32_t count : texels) EXPECT_LE(count, shared::kTexelsPerPhase);
}

TEST_F(SmokeLightCacheTest, ALightThatComesOrGoesIsNeverLate) {
  SmokeLightCache cache;
  SmokeLightInputs now = inputs();
  now.look.erosion = 0.5f;
  now.update_fraction = 0.125f;
  for (int i = 0; i < 12; ++i, now.time += 0.1f) planned(cache, now);
  std::vector<shared::Light> with = lights_;
  with.push_back(lights_[4]);
  with.back().position_world.y = 3;
  now.lights = with;
  const auto bricks_of = [&](const SmokeLightPlan& plan) {
    std::set<std::uint32_t> slots;
    for (const shared::LightGather& brick : plan.gathers)
      if (brick.texels == shared::kAllTexels) slots.insert(brick.slot);
    return slots;
  };
  const SmokeLightPlan come = planned(cache, now);
  std::set<std::uint32_t> reached;
  for (const shared::ShadowRays& rays : come.shadow_rays)
    if (rays.light == 9) {
      EXPECT_EQ(rays.texels, shared::kAllTexels);
      EXPECT_TRUE(reached.insert(rays.slot).second);
    }
  EXPECT_FALSE(reached.empty());
  EXPECT_LT(reached.size(), visibility_.visible_count);
  EXPECT_EQ(bricks_of(come), reached);
  now.time += 0.1f;
  now.lights = lights_;
  EXPECT_EQ(bricks_of(planned(cache, now)), reached);
}

TEST_F(SmokeLightCacheTest, TexelsInAHoleThatChangesAreNeverLate) {
  SmokeLightCache cache;
  SmokeLightInputs now = inputs();
  now.look.erosion = 0.5f;
  now.update_fraction = 0.125f;
  for (int i = 0; i < 12; ++i, now.time += 0.1f) planned(cache, now);
  const shared::Hole hole = open_hole({6, 1, 4}, {0, 0, 1}, 0.2f, 8, now.time - 0.01f);
  holes_ = {hole};
  now.holes = holes_;
  const SmokeLightPlan plan = planned(cache, now);
  std::set<std::uint32_t> listed;
  for (const shared::TexelList& row : plan.texel_lists) {
    listed.insert(row.slot);
    EXPECT_TRUE(row.had_list);
    ASSERT_EQ(row.change_count, 1u);
    EXPECT_EQ(plan.changes[row.first_change].from_world, hole.origin_world);
    EXPECT_GE(plan.changes[row.first_change].radius, hole.radius);
  }
  // All bricks that hold a point of its axis, and few others.
  for (float z = 4; z < 12; z += 0.1f) {
    const std::uint32_t slot = volume_.slot_at(glm::ivec3(glm::floor(glm::vec3(6, 1, z) / (8 * kVoxel))));
    EXPECT_TRUE(slot == smoke::SmokeVolume::kNoSlot || listed.count(slot) > 0);
  }
  EXPECT_LT(listed.size(), visibility_.visible_count / 2);
  // Each with all of its rays.
  std::map<std::uint32_t, std::uint32_t> pairs, wanted;
  for (const shared::ShadowRays& rays : plan.shadow_rays)
    if (rays.texels == shared::kNewTexels) ++pairs[rays.slot];
  for (const shared::LightGather& brick : plan.gathers)
    if (brick.texels == shared::kNewTexels) wanted[brick.slot] = brick.light_count + shared::kSkyPages;
  EXPECT_EQ(pairs, wanted);
  EXPECT_EQ(wanted.size(), listed.size());
}

TEST(SameOpening, HoldsOnlyWhereNothingDiffers) {
  std::mt19937 random(5);
  const auto unit = [&] { return std::uniform_real_distribution<float>(0, 1)(random); };
  int same = 0, different = 0;
  for (int i = 0; i < 20000; ++i) {
    shared::Hole hole{};
    hole.origin_world = {unit(), unit(), unit()};
    hole.forward = {0, 0, 1};
    hole.right = {1, 0, 0};
    hole.up = {0, 1, 0};
    hole.radius = 0.2f + unit();
    hole.distance_to_far = 1 + 4 * unit();
    hole.time_start = 100 * unit();
    hole.time_to_reach_far = i % 3 == 0 ? 0 : 0.5f * unit();
    hole.time_to_expand = i % 5 == 0 ? 0 : 0.3f * unit();
    hole.time_to_stay_open = 2 * unit();
    hole.time_to_fade = i % 7 == 0 ? 0 : 0.5f * unit();
    hole.shape = i % 2 == 0 ? shared::kHoleCylinder : shared::kHoleBox;
    const float a = hole.time_start - 0.5f + 4 * unit(), b = a + 0.5f * unit();
    bool equal = true;
    for (int k = 0; k < 40; ++k) {
      const glm::vec3 p =
          hole.origin_world + glm::vec3(2 * unit() - 1, 2 * unit() - 1, hole.distance_to_far * unit());
      equal &= shared::hole_strength(hole, p, a, 0) == shared::hole_strength(hole, p, b, 0);
    }
    const bool holds = same_opening(hole, a, b);
    same += holds;
    different += !equal;
    EXPECT_TRUE(equal || !holds);
  }
  EXPECT_GT(same, 3000);
  EXPECT_GT(different, 3000);
}

}  // namespace
}  // namespace brume::planning
