#include "planning/frame_plan.hpp"

#include <gtest/gtest.h>

#include "tests/frame_builder.hpp"

namespace brume::planning {
namespace {

/// A smoke that has stopped growing, a light above it.
class FramePlanTest : public ::testing::Test {
 protected:
  FramePlanTest() {
    target_.lights = lights_;
    target_.scene_bounds = {glm::vec3(0), {40, 8, 16}};
    target_.size_px = {64, 36};
    target_.smoke_shadow_atlas = {1024, 64};
  }
  /// A copy, which is valid beside later plans.
  FramePlan plan() {
    const FramePlan made = plan_frame(input_, target_, history_);
    history_.commit();
    return FramePlan(made);
  }

  static const Yard& yard() {
    static const Yard kYard({8});
    return kYard;
  }
  const std::vector<shared::Light> lights_{point_light({8, 6, 8}, glm::vec3(2), 0)};
  PlanTarget target_;
  FrameInput input_ = FrameBuilder().eye({8, 2, 30}, {8, 2, 8}, 1.2f).smoke(yard(), 3).time(4.6f).input();
  PlanHistory history_;
};

TEST_F(FramePlanTest, RaysEndLaterWhereASurfaceInViewIsBright) {
  input_.smoke.look.opaque_transmittance = 0.004f;
  input_.view.exposure = 0.5f;
  EXPECT_EQ(plan().media.frame.opaque_transmittance, 0.004f);
  // Before the camera, and two behind it, of which one moves.
  std::vector<Emitter> emitters{
      {{{8, 2, 2}, 0.5f}, 3, 4}, {{{8, 2, 60}, 0.5f}, 5, 1000}, {{{8, 2, 60}, 0.5f}, 6, 64}};
  target_.emitters = emitters;
  EXPECT_EQ(plan().media.frame.opaque_transmittance, 0.004f) << "twice as bright as the display";
  emitters[0].radiance = 32;
  EXPECT_EQ(plan().media.frame.opaque_transmittance, 1.0f / 1024 / 16);
  input_.level.hidden_objects = {3};
  EXPECT_EQ(plan().media.frame.opaque_transmittance, 0.004f);
  input_.level.moved = {{.object = 6}};
  EXPECT_EQ(plan().media.frame.opaque_transmittance, 1.0f / 1024 / 32);
}

TEST_F(FramePlanTest, APausedCameraThatFliesOnlyGathersLight) {
  const FramePlan first = plan();
  EXPECT_EQ(first.lights.size(), 1u);
  EXPECT_EQ(first.visibility.visible_count, yard().volume.slot_count());
  EXPECT_TRUE(first.smoke_shadows);
  EXPECT_FALSE(first.smoke_light->shadow_rays.empty());
  for (int i = 0; i < 10; ++i) {
    input_.view.camera.position_world += glm::vec3(0.1f, 0.05f, -0.1f);
    const FramePlan next = plan();
    EXPECT_FALSE(next.smoke_shadows);
    EXPECT_TRUE(next.smoke_light->shadow_rays.empty());
    EXPECT_FALSE(next.smoke_light->gathers.empty());
    EXPECT_FALSE(next.level_changed);
  }
}

// Holes open and close, so that indirect light changes with the time while there are any.
TEST_F(FramePlanTest, IndirectLightFollowsHoles) {
  input_.environment.bounces = 2;
  EXPECT_GT(plan().indirect_light.slices.count, 0u);
  input_.smoke.time += 0.1f;
  EXPECT_EQ(plan().indirect_light.slices.count, 0u);
  shared::Hole hole = open_hole({8, 1, 20}, {0, 0, -1}, 0.5f, 20, 4);
  hole.time_to_reach_far = hole.time_to_expand = 0.1f;
  input_.smoke.holes = {&hole, 1};
  EXPECT_GT(plan().indirect_light.slices.count, 0u);
  EXPECT_EQ(plan().indirect_light.slices.count, 0u);
  input_.smoke.time += 0.1f;
  EXPECT_GT(plan().indirect_light.slices.count, 0u);
  hole.time_start = 100;  // not shot yet: no hole
  EXPECT_GT(plan().indirect_light.slices.count, 0u);
  input_.smoke.time += 0.1f;
  EXPECT_EQ(plan().indirect_light.slices.count, 0u);
}

TEST_F(FramePlanTest, EditsAndHiddenObjectsOfTheLevelReachWhatTheyMayChange) {
  plan();
  input_.level.voxels.edits = std::make_shared<sim::EditBlocks>();
  FramePlan edited = plan();
  EXPECT_TRUE(edited.level_changed);
  EXPECT_TRUE(edited.smoke_shadows);
  EXPECT_FALSE(edited.smoke_light->shadow_rays.empty());
  input_.level.hidden_objects = {1, 3};
  plan();
  input_.level.hidden_objects = {3, 4};
  const FramePlan hidden = plan();
  EXPECT_TRUE(hidden.level_changed);
  EXPECT_TRUE(hidden.smoke_shadows);
  EXPECT_FALSE(plan().smoke_shadows);
}

// Light in such a volume is never found, but its shadow is marched.
TEST_F(FramePlanTest, ShadowsFollowAVolumeThatScattersNothing) {
  const volume::SparseVolume volume = one_brick();
  input_.volumes = {{&volume, glm::mat4(1), {glm::vec3(0), 1, glm::vec3(0), 0, 0}, {}}};
  EXPECT_TRUE(plan().smoke_shadows);
  EXPECT_FALSE(plan().smoke_shadows);
  input_.volumes[0].look.extinction = 2;
  const FramePlan changed = plan();
  EXPECT_FALSE(changed.volume_light.update);
  EXPECT_TRUE(changed.smoke_shadows);
  EXPECT_FALSE(plan().smoke_shadows);
}

TEST_F(FramePlanTest, OnlyAQuarterOfTheLightOrLessSlicesNoise) {
  input_.smoke.look.erosion = 0.5f;
  EXPECT_FALSE(plan().noise.slots_due);
  input_.quality.light_update_fraction = 0.25f;
  const FramePlan first = plan();
  ASSERT_TRUE(first.noise.slots_due);
  EXPECT_EQ(*first.noise.slots_due, first.visibility.slots) << "the frame before advected without it";
  input_.smoke.time += 0.1f;
  const FramePlan next = plan();
  ASSERT_TRUE(next.noise.slots_due);
  EXPECT_LT(next.noise.slots_due->size(), next.visibility.slots.size());
  EXPECT_EQ(next.noise.motion.clouds.size(), 1u);
  ASSERT_TRUE(next.smoke_shadows);
  EXPECT_EQ(next.smoke_shadows->spread, 2u);
}

TEST_F(FramePlanTest, AllOfATimeFollowsAgainWhatItsSliceFollowedThroughLateNoise) {
  input_.smoke.look.erosion = 0.5f;
  input_.quality.light_update_fraction = 0.25f;
  plan();
  // A flash: the slice marches all shadows, and follows all rays to it.
  input_.smoke.time += 0.1f;
  input_.environment.flashes = lights_;
  const FramePlan slice = plan();
  EXPECT_LT(slice.noise.slots_due.value().size(), slice.visibility.slots.size());
  EXPECT_EQ(slice.smoke_shadows.value().spread, 1u);
  input_.quality.light_update_fraction = 1;
  const FramePlan all = plan();
  EXPECT_TRUE(all.smoke_shadows);
  const std::size_t rays = all.smoke_light->shadow_rays.size();
  EXPECT_FALSE(plan().smoke_shadows) << "no noise is late any more";
  history_ = PlanHistory();
  EXPECT_EQ(rays, plan().smoke_light->shadow_rays.size());
}

TEST_F(FramePlanTest, AFrameThatIsNotCommittedLeavesNothingBehind) {
  plan();
  input_.environment.bounces = 2;
  input_.level.hidden_objects = {1, 3};
  input_.smoke.look.erosion = 0.5f;
  input_.quality.light_update_fraction = 0.25f;
  for (int i = 0; i < 3; ++i) {
    const FramePlan dropped = plan_frame(input_, target_, history_);
    EXPECT_TRUE(dropped.level_changed);
    EXPECT_TRUE(dropped.smoke_shadows);
    EXPECT_TRUE(dropped.indirect_light.level_changed);
    EXPECT_EQ(dropped.smoke_light->gathers.size(), dropped.visibility.visible_count);
    EXPECT_EQ(dropped.noise.slots_due.value().size(), dropped.visibility.slots.size());
  }
  plan();
  const FramePlan next = plan();
  EXPECT_FALSE(next.level_changed);
  EXPECT_FALSE(next.indirect_light.level_changed);
}

TEST_F(FramePlanTest, WithoutSmokeNothingIsUpdated) {
  input_.smoke = {};
  const FramePlan none = plan();
  EXPECT_TRUE(none.visibility.slots.empty());
  EXPECT_TRUE(none.smoke_light->parts.empty());
  EXPECT_TRUE(none.noise.motion.clouds.empty());
  EXPECT_EQ(none.holes.layout().count, 0u);
  EXPECT_FALSE(plan().smoke_shadows);
  EXPECT_TRUE(none.state().clouds.empty());
}

}  // namespace
}  // namespace brume::planning
