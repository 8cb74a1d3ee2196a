#include "planning/resident_smoke.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "tests/heap.hpp"
#include "tests/sanitized.hpp"
#include "tests/worlds.hpp"

namespace brume::planning {
namespace {

constexpr float kVoxel = 0.25f;

/// Twelve smokes in a yard with a wall, and cameras among them.
class ResidentSmokeTest : public ::testing::Test {
 protected:
  static constexpr int kAcross = 160, kHigh = 40;

  ResidentSmokeTest() {
    for (std::uint32_t i = 0; i < 12; ++i) {
      const glm::vec3 at = inside(4);
      world_.append(smoke_at(glm::dvec3(at), 400 + static_cast<std::uint32_t>(random_() % 2500), 12 * i));
    }
  }
  static voxel::BitGrid walled() {
    voxel::BitGrid grid({{kAcross, kHigh, kAcross}, kVoxel, glm::vec3(0)});
    for (int y = 0; y < 24; ++y)
      for (int z = 20; z < 140; ++z) grid.set({80, y, z}, true);
    return grid;
  }
  float unit() { return std::uniform_real_distribution<float>(0, 1)(random_); }
  glm::vec3 inside(float margin) {
    const glm::vec3 size = glm::vec3(kAcross, kHigh, kAcross) * kVoxel - 2 * margin;
    return glm::vec3(margin) + size * glm::vec3(unit(), unit(), unit());
  }
  SmokeVisibility visible(float wide = 0.5f) {
    shared::Camera camera{};
    camera.eye_world = eye_ = inside(1);
    const float yaw = 6.2832f * unit();
    camera.forward = {std::cos(yaw), 0, std::sin(yaw)};
    camera.right = wide * glm::normalize(glm::cross(camera.forward, glm::vec3(0, 1, 0)));
    camera.up = 0.6f * wide * glm::normalize(glm::cross(camera.right, camera.forward));
    const shared::Light light = point_light(inside(1), glm::vec3(0.64f), 0);  // up to 8 m
    const Box<float> scene{glm::vec3(0), glm::vec3(kAcross, kHigh, kAcross) * kVoxel};
    return cull_smoke(volume_, ViewFrustum(camera), {&light, 1}, scene);
  }
  std::set<std::uint64_t> bricks(const smoke::SmokeBricks& of, std::span<const std::uint32_t> slots) const {
    std::set<std::uint64_t> keys;
    for (const std::uint32_t slot : slots) {
      const glm::u64vec3 at(of.brick_of(slot) + 1024);
      keys.insert(at.x | at.y << 20 | at.z << 40);
    }
    return keys;
  }
  /// What a reader that follows the dirty slots holds.
  void follow() {
    const bool all = held_.volume().id() != seen_id_ || held_.revision() > seen_revision_ + 1;
    if (all) copies_.clear();
    seen_id_ = held_.volume().id();
    if (!all && held_.revision() == seen_revision_) return;
    seen_revision_ = held_.revision();
    copies_.resize(held_.slot_count());
    const auto copy = [&](std::uint32_t slot) {
      const auto texels = held_.texels(slot);
      copies_[slot].texels.assign(texels.begin(), texels.end());
      const auto cells = held_.cells(slot);
      copies_[slot].cells.assign(cells.begin(), cells.end());
    };
    if (all)
      for (std::uint32_t slot = 0; slot < held_.slot_count(); ++slot) copy(slot);
    for (const std::uint32_t slot : held_.dirty_slots()) copy(slot);
    for (const std::uint32_t slot : held_.dirty_cell_slots()) copy(slot);
  }
  void expect_same(const SmokeVisibility& own, const SmokeVisibility& seen) {
    follow();
    EXPECT_EQ(seen.visible_count, own.visible_count);
    EXPECT_EQ(bricks(held_, seen.slots), bricks(volume_, own.slots));
    for (const std::uint32_t slot : seen.slots) {
      const std::uint32_t from = volume_.slot_at(held_.brick_of(slot));
      ASSERT_NE(from, smoke::SmokeBricks::kNoSlot);
      EXPECT_TRUE(std::ranges::equal(copies_[slot].texels, volume_.texels(from))) << slot;
      EXPECT_TRUE(std::ranges::equal(copies_[slot].cells, volume_.cells(from))) << slot;
    }
  }

  struct Copy {
    std::vector<smoke::Texel> texels;
    std::vector<std::uint32_t> cells;
  };
  std::mt19937 random_{5};
  SmokeWorld world_{walled()};
  const smoke::SmokeVolume& volume_ = world_.volume;
  glm::vec3 eye_{0};
  ResidentSmoke held_;
  std::vector<Copy> copies_;
  std::uint64_t seen_id_ = 0, seen_revision_ = 0;
};

TEST_F(ResidentSmokeTest, HoldsWhatIsRequiredAsItIs) {
  std::uint32_t tick = 60;
  for (int i = 0; i < (kSanitized ? 40 : 200); ++i) {
    // Time stands still, goes on, or jumps.
    tick += std::array{0u, 1u, 1u, 7u}[random_() % 4];
    if (random_() % 4 != 0) world_.advance_to(tick);
    if (volume_.slot_count() == 0) world_.advance_to(tick);
    const SmokeVisibility own = visible();
    expect_same(own, held_.update({.volume = volume_, .eye_world = eye_}, own));
    EXPECT_FALSE(held_.is_limited());
    EXPECT_EQ(held_.level(), 0);
  }
}

TEST_F(ResidentSmokeTest, AnyAllocationOfAnUpdateMayFail) {
  int failures = 0;
  for (std::uint32_t tick = 60; tick < (kSanitized ? 100u : 160u); ++tick) {
    world_.advance_to(tick);
    const SmokeVisibility own = visible();
    SmokeVisibility seen;
    for (int fails_at = 1 + static_cast<int>(random_() % 40);; fails_at = 0) {
      Heap::allocations = 0;
      Heap::fails_at = fails_at;
      Heap::counts = true;
      try {
        seen = held_.update({.volume = volume_, .eye_world = eye_}, own);
        Heap::counts = false;
        break;
      } catch (const std::bad_alloc&) {
        Heap::counts = false;
        ++failures;
      }
    }
    expect_same(own, seen);
    ASSERT_FALSE(HasFailure()) << tick;
  }
  EXPECT_GT(failures, 10);
}

TEST_F(ResidentSmokeTest, HoldsNothingOfWhatIsOutOfView) {
  world_.advance_to(200);
  ASSERT_GT(volume_.slot_count(), 200u);
  held_.update({.volume = volume_}, {});
  EXPECT_EQ(held_.slot_count(), 0u);
  const SmokeVisibility all = all_smoke_visible(volume_);
  expect_same(all, held_.update({.volume = volume_}, all));
}

TEST_F(ResidentSmokeTest, KeepsWhatItHeldWhereThereIsRoom) {
  world_.advance_to(200);
  const SmokeVisibility all = all_smoke_visible(volume_);
  held_.update({.volume = volume_}, all);
  const std::uint64_t revision = held_.revision();
  SmokeVisibility few = all;
  few.slots.resize(10);
  few.visible_count = 10;
  held_.update({.volume = volume_}, few);
  held_.update({.volume = volume_}, all);
  EXPECT_EQ(held_.revision(), revision) << "nothing was to be uploaded";
}

TEST_F(ResidentSmokeTest, NeverHoldsMoreThanThereIsRoomFor) {
  std::uint32_t tick = 100;
  constexpr int kFrames = kSanitized ? 30 : 150;
  int limited = 0;
  for (int i = 0; i < kFrames; ++i) {
    world_.advance_to(tick += static_cast<std::uint32_t>(random_() % 3));
    const std::uint32_t most = 8u << random_() % 6;
    const SmokeVisibility own = visible(1.5f);
    const SmokeVisibility seen =
        held_.update({.volume = volume_, .eye_world = eye_, .most_bricks = most}, own);
    EXPECT_LE(held_.slot_count(), most);
    EXPECT_LE(seen.slots.size(), most);
    limited += held_.is_limited();
    if (!held_.is_limited()) expect_same(own, seen);
    // All that is in view is there, at some level.
    std::set<std::uint64_t> there = bricks(held_, std::span(seen.slots).first(seen.visible_count));
    for (std::uint32_t k = 0; k < own.visible_count && held_.level() < ResidentSmoke::kMostLevel; ++k) {
      const std::uint32_t slot = held_.slot_at(volume_.brick_of(own.slots[k]) >> held_.level());
      EXPECT_TRUE(std::ranges::binary_search(std::span(seen.slots).first(seen.visible_count), slot));
    }
  }
  EXPECT_GT(limited, kFrames / 3);
}

/// Density of a brick volume between the middles of its texels; 0 outside.
float density_at(const smoke::SmokeBricks& of, glm::vec3 p) {
  const glm::ivec3 brick = glm::ivec3(glm::floor(p)) >> 3;
  const std::uint32_t slot = of.slot_at(brick);
  if (slot == smoke::SmokeBricks::kNoSlot) return 0;
  const glm::vec3 local = p - glm::vec3(8 * brick) + 0.5f;
  const glm::ivec3 low(glm::floor(local));
  const glm::vec3 f = local - glm::vec3(low);
  float sum = 0;
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 corner(i & 1, i >> 1 & 1, i >> 2), at = low + corner;
    const glm::vec3 w = glm::mix(1.0f - f, f, glm::vec3(corner));
    sum +=
        w.x * w.y * w.z * of.texels(slot)[static_cast<std::size_t>(at.x + 10 * (at.y + 10 * at.z))].density;
  }
  return sum;
}

// Line of sight goes by the fine volume: what it hides, the picture must hide.
TEST_F(ResidentSmokeTest, CoarseSmokeIsNowhereThinner) {
  world_.advance_to(200);
  const SmokeVisibility all = all_smoke_visible(volume_);
  for (const std::uint32_t most : {128u, 32u, 8u}) {
    held_.update({.volume = volume_, .most_bricks = most}, all);
    ASSERT_GT(held_.level(), 0);
    const float scale = static_cast<float>(1 << held_.level());
    int dense = 0;
    for (int i = 0; i < 20000; ++i) {
      const std::uint32_t slot = all.slots[random_() % all.slots.size()];
      const glm::vec3 p = glm::vec3(8 * volume_.brick_of(slot)) + 8.0f * glm::vec3(unit(), unit(), unit());
      // Also beside walls, where smoke::sample_density takes from the near side.
      const float fine = 255 * smoke::sample_density(volume_, p);
      dense += fine > 0;
      ASSERT_GE(density_at(held_, p / scale) + 0.01f, fine) << held_.level() << " at " << p.x << " " << p.y;
    }
    EXPECT_GT(dense, 2000);
  }
}

}  // namespace
}  // namespace brume::planning
