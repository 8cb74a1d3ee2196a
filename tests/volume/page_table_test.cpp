#include "volume/page_table.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <tuple>

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

}  // namespace
}  // namespace brume::volume
