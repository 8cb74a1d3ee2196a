// The media of a frame together: where they are, and what rays need to know of them.
#include "planning/media_plan.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <random>
#include <set>

#include "planning/device_camera.hpp"
#include "shared/phase.h"
#include "tests/frame_builder.hpp"

namespace brume::planning {
namespace {

TEST(MediaPlan, MarchesAVolumeThatIsOpaqueWithinAVoxelByHalfAVoxel) {
  const volume::SparseVolume volume = one_brick();
  FrameInput input;
  input.view.camera = {{4, 4, 30}, {4, 4, 4}, 0.9f};
  input.volumes = {{&volume, glm::mat4(1), {glm::vec3(1), 1, glm::vec3(0), 0, 1}, {}}};
  const ViewFrustum frustum(device_camera(input.view.camera, {16, 16}));
  for (const bool dense : {false, true}) {
    // Just below and just above.
    input.volumes[0].voxel_depth = shared::kDenseVoxelDepth * (dense ? 1.001f : 0.999f);
    const MediaPlan plan = plan_media(input, {}, frustum, {});
    EXPECT_EQ((plan.media & shared::kMediumDense) != 0, dense);
    EXPECT_EQ((plan.casters & shared::kMediumDense) != 0, dense);
    EXPECT_EQ(plan.volumes[0].instance.is_dense, dense ? 1u : 0u);
    EXPECT_EQ(plan.frame.step_length, input.quality.step_scale * (dense ? 0.5f : 1.0f));
  }
}

/// The boxes of a frame.
std::vector<Box<float>> boxes_of(const shared::FrameMedia& media) {
  std::vector<Box<float>> boxes;
  for (const shared::MediaBox& box : {media.box_0, media.box_1, media.box_2, media.box_3})
    if (boxes.size() < media.box_count) boxes.push_back({box.low, box.high});
  return boxes;
}

// Volumes far from the origin, at random: their boxes are those of their corners, to the bit. There is no way
// through the voxels of the smoke, on which each coordinate x would be rounded four times: by up to
// 3 u |x - origin| + u |x|, u = 2^-24.
TEST(MediaPlan, BoxesOfVolumesAreTheirsToTheBit) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(-200, 200), size(0.01f, 3);
  const volume::SparseVolume volume = one_brick();
  for (int round = 0; round < 100; ++round) {
    FrameInput input;
    input.view.camera = {{0, 0, 900}, {0, 0, 0}, 0.9f};
    Box<float> around = kEmptyBox;
    for (int i = 0; i < 3; ++i) {
      const glm::vec3 at(place(random), place(random), place(random));
      const glm::mat4 world_from_voxel =
          glm::scale(glm::translate(glm::mat4(1), at), glm::vec3(size(random)));
      input.volumes.push_back({&volume, world_from_voxel, {glm::vec3(1), 1, glm::vec3(0), 0, 1}, {}});
    }
    const MediaPlan plan = plan_media(input, {}, ViewFrustum(device_camera(input.view.camera, {16, 16})), {});
    ASSERT_EQ(plan.frame.volume_count, 3u) << round;
    ASSERT_EQ(plan.frame.box_count, 3u) << round;
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::mat4& world_from_voxel = input.volumes[i].world_from_voxel;
      const Box<float> own{glm::vec3(world_from_voxel * glm::vec4(0, 0, 0, 1)),
                           glm::vec3(world_from_voxel * glm::vec4(8, 8, 8, 1))};
      EXPECT_EQ(boxes_of(plan.frame)[i], own) << round;
      EXPECT_EQ(plan.volumes[i].bounds_world, own) << round;
      around = united(around, own);
    }
    EXPECT_EQ(plan.frame.bounds_min, around.low) << round;
    EXPECT_EQ(plan.frame.bounds_max, around.high) << round;
    EXPECT_EQ(plan.caster_bounds, around) << round;
  }
}

// The bounds of the smoke are in its voxels. Two roundings, of the product and of the sum, of values that are
// at most |origin| + size: each corner is off by at most 2 u (|origin| + size).
TEST(MediaPlan, BoundsOfSmokeAreWithinTwoRoundings) {
  std::mt19937 random(6);
  std::uniform_real_distribution<float> place(-100, 100), size(0.05f, 0.5f), bound(0, 400);
  constexpr double kUnit = 0.5 * std::numeric_limits<float>::epsilon();
  for (int round = 0; round < 1000; ++round) {
    shared::VolumeLayout smoke{};
    smoke.origin_world = {place(random), place(random), place(random)};
    smoke.voxel_size = size(random);
    smoke.bounds_min = {bound(random), bound(random), bound(random)};
    smoke.bounds_max = smoke.bounds_min + bound(random);
    const shared::FrameMedia media = smoke_media(smoke, {});
    for (const bool high : {false, true})
      for (int axis = 0; axis < 3; ++axis) {
        const double origin = smoke.origin_world[axis],
                     reach = double{smoke.voxel_size} *
                             double{high ? smoke.bounds_max[axis] : smoke.bounds_min[axis]};
        const double bounds = high ? media.bounds_max[axis] : media.bounds_min[axis];
        EXPECT_NEAR(bounds, origin + reach, 2 * kUnit * (1 + kUnit) * (std::abs(origin) + reach)) << round;
        EXPECT_EQ(high ? media.box_0.high[axis] : media.box_0.low[axis], static_cast<float>(bounds));
      }
  }
}

TEST(MediaPlan, AFrameOfNothingHasAnEmptyBoxAndThePipelinesOfSmoke) {
  const FrameInput input;
  const MediaPlan plan = plan_media(input, {}, ViewFrustum(device_camera(input.view.camera, {16, 16})), {});
  EXPECT_EQ(plan.frame.box_count, 1u);
  EXPECT_EQ(plan.frame.box_0.low, plan.frame.box_0.high);
  EXPECT_EQ(plan.media, shared::kMediumSmoke);
  EXPECT_EQ(plan.casters, shared::kMediumSmoke);
  EXPECT_EQ(plan.caster_count, 0u);
  EXPECT_TRUE(plan.caster_bounds.empty());
  EXPECT_FALSE(plan.needs_noise);
  EXPECT_TRUE(caster_boxes(plan, {}, nullptr).empty());
}

// What absorbs nothing casts no shadow where it is not in view.
TEST(MediaPlan, CountsWhatCastsShadows) {
  const volume::SparseVolume volume = one_brick();
  FrameInput input;
  input.view.camera = {{4, 4, 30}, {4, 4, 4}, 0.9f};
  const auto add = [&](float z, float extinction) {
    input.volumes.push_back({&volume,
                             glm::translate(glm::mat4(1), glm::vec3(0, 0, z)),
                             {glm::vec3(1), extinction, glm::vec3(0), 0.3f, 1},
                             {}});
    return plan_media(input, {}, ViewFrustum(device_camera(input.view.camera, {16, 16})), {});
  };
  MediaPlan plan = add(0, 1);
  EXPECT_EQ(plan.caster_count, 1u);
  EXPECT_EQ(plan.mean_cosine, 0.3f);
  EXPECT_EQ(caster_boxes(plan, {}, nullptr).size(), 1u);
  plan = add(100, 0);
  EXPECT_EQ(plan.caster_count, 1u) << "behind the camera";
  plan = add(100, 1);
  EXPECT_EQ(plan.caster_count, 2u);
  EXPECT_EQ(plan.frame.volume_count, 1u);
  EXPECT_EQ(plan.caster_bounds, (Box<float>{glm::vec3(0), {8, 8, 108}}));
}

TEST(MediaPlan, QualitiesDifferByTheNoiseOfSmokeAlone) {
  const std::uint32_t volumes = shared::kMediumVolumes | shared::kMediumLit;
  for (const std::uint32_t other : media_of_all_qualities(volumes)) EXPECT_EQ(other, volumes);
  const std::uint32_t smoke = volumes | shared::kMediumSmoke;
  const std::set<std::uint32_t> expected{smoke, smoke | shared::kMediumFineShadows,
                                         smoke | shared::kMediumDetail, smoke | shared::kMediaOfSmoke};
  for (const std::uint32_t media : expected) {
    const auto all = media_of_all_qualities(media);
    EXPECT_EQ(std::set<std::uint32_t>(all.begin(), all.end()), expected);
  }
}

}  // namespace
}  // namespace brume::planning
