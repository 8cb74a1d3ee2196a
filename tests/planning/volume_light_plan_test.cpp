#include "planning/volume_light_plan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "planning/blackbody.hpp"
#include "planning/device_camera.hpp"
#include "tests/worlds.hpp"

namespace brume::planning {
namespace {

TEST(VolumeSweep, FitsTheBoundsAndRunsAlongTheLight) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> draw(-1, 1);
  for (int round = 0; round < 200; ++round) {
    shared::VolumeInstance volume{};
    glm::mat4 matrix(1);
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 3; ++row) matrix[column][row] = 3 * draw(random);
    const glm::mat4x3 world_from_voxel(matrix);
    volume.world_from_voxel = shared::affine_of(world_from_voxel);
    volume.bounds_min = glm::vec3(draw(random), draw(random), draw(random));
    volume.bounds_max = volume.bounds_min + 7.0f;
    const glm::vec3 direction = glm::normalize(glm::vec3(draw(random), draw(random), 0.1f + draw(random)));
    const shared::VolumeSweep sweep = sweep_through(volume, direction);

    const glm::mat4x3 world_from_sweep = matrix_of(sweep.world_from_sweep),
                      sweep_from_world = matrix_of(sweep.sweep_from_world);

    // Corners of the bounds fill the unit cube along each axis.
    glm::vec3 low(1e9f), high(-1e9f);
    for (int corner = 0; corner < 8; ++corner) {
      const glm::bvec3 side(corner & 1, corner & 2, corner & 4);
      const glm::vec3 p =
          world_from_voxel * glm::vec4(glm::mix(volume.bounds_min, volume.bounds_max, side), 1);
      const glm::vec3 at = sweep_from_world * glm::vec4(p, 1);
      low = glm::min(low, at);
      high = glm::max(high, at);
      EXPECT_LT(glm::length(world_from_sweep * glm::vec4(at, 1) - p), 1e-3f) << round;
    }
    EXPECT_LT(glm::length(low), 1e-3f) << round;
    EXPECT_LT(glm::length(high - 1.0f), 1e-3f) << round;
    const glm::vec3 along = world_from_sweep * glm::vec4(0, 0, 1, 0);
    EXPECT_NEAR(glm::length(along), sweep.length_m, 1e-3f * sweep.length_m) << round;
    EXPECT_LT(glm::length(along / sweep.length_m - direction), 1e-4f) << round;
  }
}

/// A brick of density.
class VolumeLightCacheTest : public testing::Test {
 protected:
  VolumeLightCacheTest() {
    volume::SparseVolumeInfo info;
    info.channels = {{2}};
    volume_ = std::make_unique<volume::SparseVolume>(info);
    volume_->begin_update();
    volume_->acquire({0, 0, 0});
    volume_->set_bounds(glm::vec3(0), glm::vec3(8));
    volume_->end_update();
    inputs_ = {{volume_.get(), glm::mat4(1), {glm::vec3(1), 1, glm::vec3(0), 0, 1}, {}}};
  }
  VolumeLightPlan plan() {
    MediaPlan media;
    media.media = media.casters = shared::kMediumVolumes | (is_lit_ ? shared::kMediumLit : 0);
    media.frame.volume_count = media.frame.caster_count = media.caster_count = 1;
    PlacedVolume visible;
    visible.instance.voxel_from_world = visible.instance.world_from_voxel =
        shared::affine_of(glm::mat4x3(inputs_[0].world_from_voxel));
    visible.instance.bounds_max = size_;
    visible.instance.is_dense = is_dense_ ? 1 : 0;
    visible.instance.look = inputs_[0].look;
    media.volumes = {visible};
    media.sun = 0;
    media.frame.to_sun = -lights_[0].direction;
    VolumeLightPlan plan = cache_.plan({.media = &media,
                                        .volumes = inputs_,
                                        .lights = lights_,
                                        .time = time_,
                                        .rebuild = rebuild_,
                                        .room = room_});
    if (commits_) {
      cache_.commit();
      room_ = {plan.edge, plan.sun_edge, 1, 1};
    }
    return plan;
  }
  VolumeLightRoom room_;
  bool commits_ = true;

  std::unique_ptr<volume::SparseVolume> volume_;
  std::vector<VolumeInput> inputs_;
  std::vector<shared::Light> lights_{sun_light({0, -1, 0}, 1, 0)};
  float time_ = 0;
  glm::vec3 size_{8};
  bool rebuild_ = false, is_lit_ = true, is_dense_ = false;
  VolumeLightCache cache_;
};

// What only glows has no light; once it scatters, light is found whatever was there before.
TEST_F(VolumeLightCacheTest, NothingIsFoundForWhatScattersNothing) {
  EXPECT_TRUE(plan().update);
  is_lit_ = false;
  EXPECT_FALSE(plan().update);
  EXPECT_FALSE(plan().is_lit);
  is_lit_ = true;
  EXPECT_TRUE(plan().update);
  EXPECT_FALSE(plan().update);
}

TEST_F(VolumeLightCacheTest, UpdatesOnlyWhereAnInputOfTheLightChanged) {
  EXPECT_TRUE(plan().update);
  EXPECT_EQ(plan().sweeps.size(), shared::kSweepsOfVolume);
  EXPECT_FALSE(plan().update);
  time_ = 2;  // without smoke no clock matters
  EXPECT_FALSE(plan().update);
  inputs_[0].look.extinction = 2;
  EXPECT_TRUE(plan().update);
  EXPECT_FALSE(plan().update);
  lights_[0].direction = {1, 0, 0};
  EXPECT_TRUE(plan().update);
  volume_->begin_update();
  volume_->mark_dirty(volume::ChannelId{0}, 0);
  volume_->end_update();
  EXPECT_TRUE(plan().update);
  for (const auto& change : std::vector<std::function<void(TransferInput&)>>{
           [](TransferInput& transfer) {
             transfer.opacity = {{0, 0}, {1, 1}};
           },
           [](TransferInput& transfer) { transfer.opacity[1].opacity = 0.5f; },
           [](TransferInput& transfer) { transfer.color_map.name = "viridis"; },
           [](TransferInput& transfer) { transfer.color_map.name = "inferno"; },
           [](TransferInput& transfer) {
             transfer.color_map = {"", {{0, {1, 0, 0}}, {1, {0, 0, 1}}}};
           },
           [](TransferInput& transfer) { transfer.color_map.points[0].color.g = 0.5f; }}) {
    change(inputs_[0].transfer);
    EXPECT_TRUE(plan().update);
    EXPECT_FALSE(plan().update);
  }
  rebuild_ = true;
  EXPECT_TRUE(plan().update);
  rebuild_ = false;
  EXPECT_FALSE(plan().update);
  cache_.invalidate();
  EXPECT_TRUE(plan().update);
}

TEST_F(VolumeLightCacheTest, AFrameThatIsNotCommittedIsPlannedAgain) {
  commits_ = false;
  EXPECT_TRUE(plan().update);
  EXPECT_TRUE(plan().update);
  commits_ = true;
  EXPECT_TRUE(plan().update);
  EXPECT_FALSE(plan().update);
}

TEST_F(VolumeLightCacheTest, LightIsFoundAgainWhereTheDeviceHasNoRoomForIt) {
  plan();
  for (const VolumeLightRoom& less : {VolumeLightRoom{1, room_.sun_edge, 1, 1},
                                      {room_.edge, 1, 1, 1},
                                      {room_.edge, room_.sun_edge, 0, 1}}) {
    EXPECT_FALSE(plan().update);
    room_ = less;
    EXPECT_TRUE(plan().update);
  }
}

TEST_F(VolumeLightCacheTest, ADenseVolumeHasACellPerVoxel) {
  size_ = {100, 20, 60};
  EXPECT_EQ(plan().edge, 32u);
  is_dense_ = true;
  const VolumeLightPlan dense = plan();
  EXPECT_TRUE(dense.update);
  EXPECT_EQ(dense.edge, 128u);
  size_ = glm::vec3(1000);
  EXPECT_EQ(plan().edge, 128u) << "at most";
}

TEST(Blackbody, HasTheColoursOfTheLocus) {
  EXPECT_EQ(blackbody_color(0), glm::vec3(0));
  EXPECT_EQ(blackbody_color(NAN), glm::vec3(0));
  const auto luminance = [](glm::vec3 c) { return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b; };
  // Red before green before blue, and no blue at all, where things only glow.
  const glm::vec3 ember = blackbody_color(1200);
  EXPECT_GT(ember.r, 2 * ember.g);
  EXPECT_EQ(ember.b, 0);
  // Chromaticity of 6504 K on the Planckian locus: x = 0.3135, y = 0.3237 (Wyszecki and Stiles), near the
  // white of sRGB.
  const glm::vec3 white = blackbody_color(6504) / luminance(blackbody_color(6504));
  EXPECT_NEAR(white.r, 1, 0.05f);
  EXPECT_NEAR(white.g, 1, 0.03f);
  EXPECT_NEAR(white.b, 1, 0.06f);
  // The fourth power, where no component is cut off.
  EXPECT_NEAR(luminance(blackbody_color(8000)) / luminance(blackbody_color(4000)), 16, 0.05f);
  EXPECT_NEAR(luminance(blackbody_color(4000)), std::pow(4000 / kUnitGlow, 4), 0.05f);
}

}  // namespace
}  // namespace brume::planning
