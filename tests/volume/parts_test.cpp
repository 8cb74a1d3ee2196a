#include "volume/parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

namespace brume::volume {
namespace {

/// Bricks at random, a third of them uniform, with texels of their own.
SparseVolume scattered(int count, std::mt19937& random) {
  std::uniform_int_distribution<int> at(-9, 14);
  SparseVolume volume({{}, 1, {{2}}});
  volume.begin_update();
  for (int i = 0; i < count;) {
    const glm::ivec3 brick(at(random), at(random) / 2, at(random));
    if (volume.slot_at(brick) != SparseVolume::kNoSlot || volume.uniform_at(brick)) continue;
    if (i % 3 == 2) {
      volume.set_uniform(brick, static_cast<std::uint16_t>(i));
    } else {
      std::ranges::fill(volume.texels<std::uint16_t>(ChannelId{0}, volume.acquire(brick)),
                        static_cast<std::uint16_t>(i));
    }
    ++i;
  }
  volume.set_bounds(glm::vec3(-80), glm::vec3(120));
  volume.end_update();
  return volume;
}

/// The most bricks with a slot that have one coordinate in common.
double largest_layer(const SparseVolume& volume) {
  double largest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::map<int, int> layers;
    for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot)
      largest = std::max(largest, double(++layers[volume.brick_of(slot)[axis]]));
  }
  return largest;
}

TEST(Parts, HoldEachBrickOnceAndAboutAsMany) {
  std::mt19937 random(5);
  const SparseVolume whole = scattered(600, random);
  for (const std::uint32_t count : {1u, 2u, 3u, 4u, 7u, 16u}) {
    const Parts parts = Parts::divide(whole, count).value_or_throw();
    ASSERT_EQ(parts.count(), count);
    std::uint32_t slots = 0;
    std::size_t uniform = 0;
    for (std::uint32_t number = 0; number < count; ++number) {
      const SparseVolume part = part_of_volume(whole, parts, number);
      slots += part.slot_count();
      uniform += part.uniform_bricks().size();
      // Each division is off by at most half of a layer of bricks, and passes on at most two thirds of that.
      EXPECT_NEAR(part.slot_count(), 400.0 / count, 1.5 * largest_layer(whole)) << count;
      for (std::uint32_t slot = 0; slot < part.slot_count(); ++slot) {
        const std::uint32_t from = whole.slot_at(part.brick_of(slot));
        ASSERT_NE(from, SparseVolume::kNoSlot);
        EXPECT_TRUE(std::ranges::equal(part.channel(ChannelId{0}, slot), whole.channel(ChannelId{0}, from)));
      }
      for (const UniformBrick& brick : part.uniform_bricks())
        EXPECT_EQ(whole.uniform_at(brick.at), brick.texel);
      EXPECT_EQ(part.layout().bounds_min, whole.layout().bounds_min);
      EXPECT_EQ(part.layout().bounds_max, whole.layout().bounds_max);
      ASSERT_EQ(part.boxes().size(), whole.boxes().size());
      for (std::size_t i = 0; i < part.boxes().size(); ++i) {
        EXPECT_EQ(part.boxes()[i].low, whole.boxes()[i].low);
        EXPECT_EQ(part.boxes()[i].high, whole.boxes()[i].high);
      }
    }
    EXPECT_EQ(slots, 400u);
    EXPECT_EQ(uniform, 200u);
  }
}

// Along any ray from the eye, parts follow each other in the order of visibility, and none comes twice.
TEST(Parts, HaveOneOrderOfVisibility) {
  std::mt19937 random(9);
  const SparseVolume whole = scattered(300, random);
  const Parts parts = Parts::divide(whole, 11).value_or_throw();
  std::uniform_real_distribution<float> place(-150, 200);
  for (int ray = 0; ray < 200; ++ray) {
    const glm::vec3 eye(place(random), place(random), place(random));
    const glm::vec3 towards(place(random), place(random), place(random));
    const std::vector<std::uint32_t> order = parts.order_from(eye);
    std::vector<std::uint32_t> sorted = order;
    std::ranges::sort(sorted);
    ASSERT_EQ(sorted.size(), 11u);
    for (std::uint32_t i = 0; i < 11; ++i) EXPECT_EQ(sorted[i], i);
    std::ptrdiff_t rank = 0;
    for (int step = 0; step <= 1000; ++step) {
      const glm::vec3 p = eye + (towards - eye) * (0.003f * static_cast<float>(step));
      const std::uint32_t part = parts.part_of(glm::ivec3(glm::floor(p / 8.0f)));
      const auto here = std::ranges::find(order, part) - order.begin();
      ASSERT_GE(here, rank);
      rank = here;
    }
  }
}

TEST(Parts, RefuseMoreThanThereAreBricks) {
  std::mt19937 random(1);
  const SparseVolume whole = scattered(6, random);
  EXPECT_TRUE(Parts::divide(whole, 4));
  EXPECT_FALSE(Parts::divide(whole, 5));
  EXPECT_FALSE(Parts::divide(whole, 0));
}

}  // namespace
}  // namespace brume::volume
