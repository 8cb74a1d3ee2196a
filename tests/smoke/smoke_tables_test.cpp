// What the smoke volume is laid out with: page table, ranges, packed planes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <tuple>
#include <vector>

#include "smoke/pack_plane.hpp"
#include "volume/page_table.hpp"
#include "volume/range_arena.hpp"

namespace brume::smoke {
namespace {

TEST(PageTable, AnswersAsAMapDoes) {
  std::mt19937 random(5);
  volume::PageTable table;
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
      table.set({x, y, z}, volume::PageTable::kNoSlot);
      map.erase(map.begin());
    }
    const glm::ivec3 probe = brick_of();
    const auto found = map.find({probe.x, probe.y, probe.z});
    ASSERT_EQ(table.at(probe), found == map.end() ? volume::PageTable::kNoSlot : found->second);
  }
  for (const auto& [key, slot] : map)
    EXPECT_EQ(table.at({std::get<0>(key), std::get<1>(key), std::get<2>(key)}), slot);
  while (!map.empty()) {
    const auto [x, y, z] = map.begin()->first;
    table.set({x, y, z}, volume::PageTable::kNoSlot);
    map.erase(map.begin());
  }
  EXPECT_EQ(table.size(), glm::ivec3(0));
  EXPECT_TRUE(table.root().empty());
}

TEST(RangeArena, GivesNothingTwice) {
  std::mt19937 random(6);
  volume::RangeArena arena;
  std::vector<volume::IndexRange> held;
  std::vector<bool> used;
  std::uint64_t most = 0, in_use = 0;
  for (int i = 0; i < 20000; ++i) {
    if (random() % 2 == 0 || held.empty()) {
      const auto count = static_cast<std::uint32_t>(1 + random() % (i % 50 == 0 ? 5000 : 60));
      const volume::IndexRange range = arena.take(count);
      ASSERT_EQ(range.count, count);
      ASSERT_LE(range.first + count, arena.end());
      used.resize(std::max<std::size_t>(used.size(), arena.end()));
      for (std::uint32_t k = 0; k < count; ++k) {
        ASSERT_FALSE(used[range.first + k]);
        used[range.first + k] = true;
      }
      held.push_back(range);
      in_use += count;
    } else {
      std::swap(held[random() % held.size()], held.back());
      for (std::uint32_t k = 0; k < held.back().count; ++k) used[held.back().first + k] = false;
      in_use -= held.back().count;
      arena.give_back(held.back());
      held.pop_back();
    }
    most = std::max(most, in_use);
  }
  for (const volume::IndexRange& range : held) arena.give_back(range);
  EXPECT_EQ(arena.end(), 0u);
  EXPECT_GT(most, 1000u);
}

TEST(PackPlane, KeepsNormalAndOffset) {
  std::mt19937 random(4);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> offset(-1, 1);
  // Half a step of the map is 1/1022 per axis. On a face of the octahedron a move of (dx, dy) is one of at
  // most sqrt(3) its length, seen from a distance of at least 1 / sqrt(3): three times the angle.
  const double bound = 3 * std::sqrt(2.0) / 1022;
  for (int i = 0; i < 20000; ++i) {
    voxel::Plane plane{glm::normalize(glm::vec3(normal(random), normal(random), normal(random))),
                       offset(random)};
    if (i < 6) plane.normal = glm::vec3(i % 3 == 0, i % 3 == 1, i % 3 == 2) * (i < 3 ? 1.0f : -1.0f);
    const std::uint32_t packed = pack_plane(plane);
    ASSERT_NE(packed, 0u);
    const glm::dvec3 n(shared::plane_normal(packed));
    EXPECT_NEAR(glm::length(n), 1, 1e-6);
    EXPECT_LE(std::atan2(glm::length(glm::cross(n, glm::dvec3(plane.normal))),
                         glm::dot(n, glm::dvec3(plane.normal))),
              i < 6 ? 1e-6 : bound);
    EXPECT_NEAR(shared::plane_offset(packed), plane.offset, 1.0 / 4094 + 1e-6);
  }
  EXPECT_NE(pack_plane({glm::vec3(0, 0, -1), -1}), 0u);
  EXPECT_NEAR(shared::plane_normal(pack_plane({glm::vec3(0, 0, -1), -1})).z, -1, 1e-6);
}

}  // namespace
}  // namespace brume::smoke
