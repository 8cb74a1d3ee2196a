#include "planning/volume_streaming.hpp"

#include <gtest/gtest.h>

#include <array>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <random>
#include <set>

#include "planning/device_camera.hpp"

namespace brume::planning {
namespace {

constexpr std::uint64_t kBrickBytes = 2000;

std::unique_ptr<volume::SparseVolume> random_bricks(std::uint32_t seed, int count, int reach) {
  auto volume = std::make_unique<volume::SparseVolume>(volume::SparseVolumeInfo{{}, 1, {{2}}});
  volume->begin_update();
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> at(-reach, reach);
  while (static_cast<int>(volume->slot_count()) < count) {
    const glm::ivec3 brick(at(random), at(random), at(random));
    if (volume->slot_at(brick) == volume::SparseVolume::kNoSlot) volume->acquire(brick);
  }
  volume->set_bounds(glm::vec3(glm::ivec3(-8 * reach)), glm::vec3(glm::ivec3(8 * reach + 8)));
  volume->end_update();
  return volume;
}

/// Two volumes with previews, a small one without, and a camera between them.
class VolumeStreamingTest : public testing::Test {
 protected:
  VolumeStreamingTest() {
    const glm::mat4 small = glm::scale(glm::mat4(1), glm::vec3(0.1f));
    inputs_ = {{big_.get(), small, {}, {}, preview_.get(), small},
               {other_.get(), glm::translate(small, glm::vec3(90, 0, -150)), {}, {}, preview_.get(), small},
               {preview_.get(), small, {}, {}}};
  }
  static ViewFrustum frustum_of(const scene::Camera& camera) {
    return ViewFrustum(device_camera(camera, {160, 90}));
  }
  std::vector<VolumeResidency> plan(std::uint64_t budget) {
    auto residency = streaming_.plan(inputs_, frustum_of(camera_), camera_.position_world, budget);
    if (commits_) streaming_.commit();
    return residency;
  }
  bool commits_ = true;
  /// Around a cube of voxels, without the code that is tested.
  static WorldSphere sphere(const VolumeInput& volume, glm::ivec3 first, int edge) {
    const glm::vec3 middle = glm::vec3(first) + 0.5f * static_cast<float>(edge);
    WorldSphere sphere{glm::vec3(volume.world_from_voxel * glm::vec4(middle, 1)), 0};
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec3 side(corner & 1, corner >> 1 & 1, corner >> 2);
      const glm::vec4 at(glm::vec3(first) + side * static_cast<float>(edge), 1);
      sphere.radius =
          std::max(sphere.radius, glm::length(glm::vec3(volume.world_from_voxel * at) - sphere.centre));
    }
    return sphere;
  }
  bool is_visible(std::size_t volume, std::uint32_t slot) const {
    const glm::ivec3 first = inputs_[volume].volume->brick_of(slot) * 8;
    return frustum_of(camera_).may_intersect(sphere(inputs_[volume], first, 8));
  }
  /// From the eye to the node of a brick.
  float node_distance(std::size_t volume, std::uint32_t slot) const {
    const glm::ivec3 first = (inputs_[volume].volume->brick_of(slot) >> 3) * 64;
    const WorldSphere node = sphere(inputs_[volume], first, 64);
    return std::max(glm::length(node.centre - camera_.position_world) - node.radius, 0.0f);
  }
  bool misses_visible(std::size_t volume) const {
    for (std::uint32_t slot = 0; slot < inputs_[volume].volume->slot_count(); ++slot)
      if (is_visible(volume, slot) && !resident_[volume].contains(slot)) return true;
    return false;
  }
  std::size_t page_bytes(std::size_t volume) const {
    const volume::PageTable& pages = inputs_[volume].volume->pages();
    return pages.root().size_bytes() + pages.nodes().size_bytes();
  }
  /// Enters what a plan uploads; returns its bytes.
  std::uint64_t upload(const std::vector<VolumeResidency>& plan) {
    std::uint64_t bytes = 0;
    for (std::size_t i = 0; i < plan.size(); ++i) {
      if (plan[i].volume.pages) bytes += page_bytes(i);
      bytes += kBrickBytes * plan[i].volume.slots.size();
      EXPECT_TRUE(std::ranges::is_sorted(plan[i].volume.slots));
      for (const std::uint32_t slot : plan[i].volume.slots)
        EXPECT_TRUE(resident_[i].insert(slot).second) << "each once";
    }
    return bytes;
  }

  std::unique_ptr<volume::SparseVolume> big_ = random_bricks(1, 3000, 20), other_ = random_bricks(2, 900, 12),
                                        preview_ = random_bricks(3, 40, 3);
  std::vector<VolumeInput> inputs_;
  scene::Camera camera_{{2, 1, 25}, {0, 0, 0}, 0.5f};
  VolumeStreaming streaming_;
  std::array<std::set<std::uint32_t>, 3> resident_;
};

TEST_F(VolumeStreamingTest, HoldsItsBudgetAndUploadsTheVisibleAndNearFirst) {
  const std::uint64_t budget = 600000;  // more than either page table
  float last_visible = 0;
  int frames = 0, frames_before_visible = 0;
  bool all_visible = false;
  do {
    ASSERT_LT(++frames, 100);
    const auto residency = plan(budget);
    EXPECT_LE(upload(residency), budget);
    EXPECT_FALSE(residency[2].volume.streamed) << "without a preview";

    // What came in this frame, by distance: nothing nearer may come later.
    float first_visible = 1e30f, most_visible = 0;
    bool any_other = false;
    for (std::size_t i = 0; i < 2; ++i)
      for (const std::uint32_t slot : residency[i].volume.slots) {
        const float distance = node_distance(i, slot);
        if (is_visible(i, slot)) {
          first_visible = std::min(first_visible, distance);
          most_visible = std::max(most_visible, distance);
          EXPECT_FALSE(all_visible);
        } else {
          any_other = true;
        }
      }
    EXPECT_GE(first_visible, last_visible - 1e-3f);
    last_visible = std::max(last_visible, most_visible);
    all_visible = !misses_visible(0) && !misses_visible(1);
    if (any_other) {
      EXPECT_TRUE(all_visible) << "what is not in view waits";
    }
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(residency[i].shows_preview, misses_visible(i)) << "volume " << i << ", frame " << frames;
      EXPECT_EQ(residency[i].lit_by_preview, resident_[i].size() < inputs_[i].volume->slot_count());
    }
    frames_before_visible += !all_visible;
  } while (!streaming_.complete());
  EXPECT_EQ(resident_[0].size(), big_->slot_count());
  EXPECT_EQ(resident_[1].size(), other_->slot_count());
  EXPECT_GT(frames_before_visible, 1);
  EXPECT_GT(frames, frames_before_visible + 2);
  EXPECT_EQ(upload(plan(budget)), 0u) << "all is there";
}

TEST_F(VolumeStreamingTest, WithoutALimitAllComesAtOnce) {
  const auto residency = plan(0);
  upload(residency);
  EXPECT_TRUE(streaming_.complete());
  EXPECT_FALSE(residency[0].shows_preview || residency[0].lit_by_preview);
  EXPECT_EQ(resident_[0].size() + resident_[1].size(), big_->slot_count() + other_->slot_count());
}

TEST_F(VolumeStreamingTest, ATurnOfTheCameraShowsThePreviewUntilItsBricksAreThere) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> draw(-30, 30);
  int back_to_preview = 0;
  bool showed_all = false;
  for (int frame = 0; frame == 0 || !streaming_.complete(); ++frame) {
    ASSERT_LT(frame, 100);
    if (frame % 3 == 2) camera_.position_world = {draw(random), draw(random), draw(random)};
    const std::uint64_t budget = frame == 0 ? 600000 : 300000;
    const auto residency = plan(budget);
    EXPECT_LE(upload(residency), budget);
    EXPECT_EQ(residency[0].shows_preview, misses_visible(0)) << frame;
    back_to_preview += showed_all && residency[0].shows_preview;
    showed_all = !residency[0].shows_preview;
  }
  EXPECT_TRUE(streaming_.complete());
  EXPECT_GT(back_to_preview, 0);
}

// A page table that the budget has no room for comes alone, so that every budget ends.
TEST_F(VolumeStreamingTest, ATinyBudgetEnds) {
  inputs_.resize(1);
  inputs_[0].volume = other_.get();
  int frames = 0;
  do {
    ASSERT_LT(++frames, 2000);
    const auto residency = plan(kBrickBytes);
    upload(residency);
    if (frames == 1) {
      EXPECT_TRUE(residency[0].volume.pages && residency[0].volume.slots.empty());
    } else {
      EXPECT_EQ(residency[0].volume.slots.size(), 1u);
    }
  } while (!streaming_.complete());
  EXPECT_EQ(frames, 1 + static_cast<int>(other_->slot_count()));
}

TEST_F(VolumeStreamingTest, AFrameThatIsNotCommittedIsPlannedAgain) {
  upload(plan(300000));
  commits_ = false;
  const auto dropped = plan(300000);
  EXPECT_FALSE(dropped[0].volume.slots.empty());
  commits_ = true;
  const auto again = plan(300000);
  const auto next = plan(300000);
  for (std::size_t i = 0; i < inputs_.size(); ++i) EXPECT_EQ(again[i].volume.slots, dropped[i].volume.slots);
  EXPECT_NE(next[0].volume.slots, again[0].volume.slots);
}

TEST_F(VolumeStreamingTest, WhatIsLostComesAgain) {
  upload(plan(0));
  for (auto& slots : resident_) slots.clear();
  streaming_.lose(other_->id());
  const auto residency = plan(0);
  upload(residency);
  EXPECT_TRUE(residency[1].volume.pages);
  EXPECT_EQ(resident_[1].size(), other_->slot_count());
  EXPECT_TRUE(resident_[0].empty());
}

TEST_F(VolumeStreamingTest, WhatIsShownTwiceIsUploadedOnceWithTheFirst) {
  // The second one is nearer.
  inputs_[1] = inputs_[0];
  inputs_[0].world_from_voxel = glm::translate(glm::mat4(1), glm::vec3(500)) * inputs_[0].world_from_voxel;
  for (int frames = 0; frames == 0 || !streaming_.complete(); ++frames) {
    ASSERT_LT(frames, 100);
    const auto residency = plan(600000);
    upload(residency);
    EXPECT_EQ(residency[0].volume.pages, frames == 0);
    EXPECT_FALSE(residency[1].volume.streamed || residency[1].volume.pages);
    EXPECT_TRUE(residency[1].volume.slots.empty());
    EXPECT_EQ(residency[1].lit_by_preview, resident_[0].size() < big_->slot_count());
  }
  EXPECT_EQ(resident_[0].size(), big_->slot_count());
}

TEST_F(VolumeStreamingTest, TheOrderIsAFunctionOfItsInputs) {
  VolumeStreaming again;
  for (int frame = 0; frame < 10; ++frame) {
    const auto a = plan(300000);
    const auto b = again.plan(inputs_, frustum_of(camera_), camera_.position_world, 300000);
    again.commit();
    for (std::size_t i = 0; i < inputs_.size(); ++i) EXPECT_EQ(a[i].volume.slots, b[i].volume.slots);
  }
}

// A heat with a preview is streamed with its density.
TEST_F(VolumeStreamingTest, DensityAndHeatSwitchTogether) {
  inputs_.resize(1);
  inputs_[0].heat.volume = other_.get();
  inputs_[0].heat.world_from_voxel = inputs_[0].world_from_voxel;
  inputs_[0].heat.preview = preview_.get();
  do {
    const auto residency = plan(400000);
    upload(residency);
    if (misses_visible(0)) {
      EXPECT_TRUE(residency[0].shows_preview);
    }
  } while (!streaming_.complete());
  EXPECT_FALSE(plan(400000)[0].shows_preview);
}

}  // namespace
}  // namespace brume::planning
