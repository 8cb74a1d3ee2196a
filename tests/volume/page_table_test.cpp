#include "volume/page_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <tuple>
#include <vector>

#include "core/box.hpp"

namespace brume::volume {
namespace {

TEST(PageTable, AnswersAsAMapDoes) {
  std::mt19937 random(5);
  PageTable table;
  std::map<std::tuple<int, int, int>, std::uint32_t> map;
  const auto brick_of = [&] {
    return glm::ivec3(random() % 20, random() % 9, random() % 70) - glm::ivec3(2, 1, 0);
  };
  for (int i = 0; i < 4000; ++i) {
    const glm::ivec3 brick = brick_of();
    // More comes than goes, then more goes.
    if (random() % 4 < (i < 2000 ? 3u : 1u)) {
      const auto slot = static_cast<std::uint32_t>(random() % 1000);
      table.set(brick, slot);
      map[{brick.x, brick.y, brick.z}] = slot;
    } else if (!map.empty()) {
      const auto [x, y, z] = map.begin()->first;
      table.set({x, y, z}, PageTable::kNoSlot);
      map.erase(map.begin());
    }
    const glm::ivec3 probe = brick_of();
    const auto found = map.find({probe.x, probe.y, probe.z});
    ASSERT_EQ(table.at(probe), found == map.end() ? PageTable::kNoSlot : found->second);
  }
  for (const auto& [key, slot] : map)
    EXPECT_EQ(table.at({std::get<0>(key), std::get<1>(key), std::get<2>(key)}), slot);
  while (!map.empty()) {
    const auto [x, y, z] = map.begin()->first;
    table.set({x, y, z}, PageTable::kNoSlot);
    map.erase(map.begin());
  }
  EXPECT_EQ(table.size(), glm::ivec3(0));
  EXPECT_TRUE(table.root().empty());
}

TEST(PageTable, HasTheSmallestWindowOfItsNodes) {
  PageTable table;
  table.set({-1, 0, 0}, 5);
  table.set({17, -9, 3}, 6);
  EXPECT_EQ(table.origin(), glm::ivec3(-1, -2, 0));
  EXPECT_EQ(table.size(), glm::ivec3(4, 3, 1));
  table.set({17, -9, 3}, PageTable::kNoSlot);
  EXPECT_EQ(table.origin(), glm::ivec3(-1, 0, 0));
  EXPECT_EQ(table.size(), glm::ivec3(1));
  EXPECT_EQ(table.at({-1, 0, 0}), 5u);
  EXPECT_EQ(table.at({17, -9, 3}), PageTable::kNoSlot);
}

TEST(PageTable, KnowsHowFarTheNearestNodeIs) {
  std::mt19937 random(6);
  for (int i = 0; i < 60; ++i) {
    PageTable table;
    std::vector<glm::ivec3> nodes;
    const int count = 1 + static_cast<int>(random() % 6), spread = 1 + static_cast<int>(random() % 12);
    for (int n = 0; n < count; ++n) {
      nodes.push_back(glm::ivec3(random() % 40, random() % 40, random() % 40) % spread - 3);
      table.set(8 * nodes.back() + 7, 1);
    }
    table.find_distances();
    for_each_in(Box<int>{glm::ivec3(0), table.size()}, [&](glm::ivec3 at) {
      int nearest = 1000;
      for (const glm::ivec3 node : nodes) {
        const glm::ivec3 away = glm::abs(node - at - table.origin());
        nearest = std::min(nearest, std::max({away.x, away.y, away.z}));
      }
      const std::uint32_t entry =
          table.root()[static_cast<std::size_t>(at.x + table.size().x * (at.y + table.size().y * at.z))];
      if (nearest == 0)
        ASSERT_GE(entry, shared::kFirstNode);
      else
        ASSERT_EQ(entry, static_cast<std::uint32_t>(nearest));
    });
  }
}

TEST(PageTable, GroupsNodesThatTouch) {
  PageTable table;
  EXPECT_TRUE(table.groups(4).empty());
  table.set({0, 0, 0}, 0);
  table.set({8, 8, 8}, 1);  // touches by a corner
  table.set({8 * 20, 0, 0}, 2);
  const Box<int> near{glm::ivec3(0), glm::ivec3(2)}, far{{20, 0, 0}, {21, 1, 1}};
  EXPECT_EQ(table.groups(4), (std::vector{near, far}));
  EXPECT_EQ(table.groups(1), std::vector{united(near, far)});
  // Of three, the two that are near each other are joined.
  table.set({8 * 23, 0, 0}, 3);
  EXPECT_EQ(table.groups(2), (std::vector{near, Box<int>{{20, 0, 0}, {24, 1, 1}}}));
  table.set({8 * 20, 0, 0}, PageTable::kNoSlot);
  EXPECT_EQ(table.groups(4), (std::vector{near, Box<int>{{23, 0, 0}, {24, 1, 1}}}));
}

TEST(PageTable, GroupsHoldEveryNode) {
  std::mt19937 random(7);
  for (int i = 0; i < 40; ++i) {
    PageTable table;
    std::vector<glm::ivec3> nodes;
    const int count = 1 + static_cast<int>(random() % 40), spread = 1 + static_cast<int>(random() % 60);
    for (int n = 0; n < count; ++n) {
      nodes.push_back(glm::ivec3(random() % 60, random() % 60, random() % 60) % spread);
      table.set(8 * nodes.back() + 3, 1);
    }
    const std::vector<Box<int>> boxes = table.groups(4);
    EXPECT_GE(boxes.size(), 1u);
    EXPECT_LE(boxes.size(), 4u);
    for (const glm::ivec3 node : nodes)
      EXPECT_TRUE(std::ranges::any_of(boxes, [&](const Box<int>& box) { return box.contains(node); }));
  }
}

TEST(PageTable, CountsDistancesUpToTheFirstNode) {
  PageTable table;
  table.set({0, 0, 0}, 1);
  table.set({8 * 700, 0, 0}, 2);
  table.find_distances();
  EXPECT_EQ(table.root()[350], shared::kFirstNode - 1);
  EXPECT_EQ(table.root()[100], 100u);
  EXPECT_EQ(table.root()[690], 10u);
}

}  // namespace
}  // namespace brume::volume
