#include "volume/range_arena.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

namespace brume::volume {
namespace {

TEST(RangeArena, GivesNothingTwice) {
  std::mt19937 random(6);
  RangeArena arena;
  std::vector<IndexRange> held;
  std::vector<bool> used;
  std::uint64_t most = 0, in_use = 0;
  for (int i = 0; i < 20000; ++i) {
    if (random() % 2 == 0 || held.empty()) {
      const auto count = static_cast<std::uint32_t>(1 + random() % (i % 50 == 0 ? 5000 : 60));
      const IndexRange range = arena.take(count);
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
  for (const IndexRange& range : held) arena.give_back(range);
  EXPECT_EQ(arena.end(), 0u);
  EXPECT_GT(most, 1000u);
}

TEST(RangeArena, RefusesIndicesBeyond32Bits) {
  RangeArena arena;
  arena.take(1u << 31);
  try {
    arena.take(1u << 31);
    FAIL() << "an index of 33 bits";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::resource_limit);
  }
}

}  // namespace
}  // namespace brume::volume
