#include "core/row_packer.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "core/box.hpp"

namespace brume {
namespace {

TEST(RowPacker, PlacesRectanglesApartInTheAtlasUntilTheyDoNotFit) {
  std::mt19937 random(12);
  for (int round = 0; round < 200; ++round) {
    const glm::uvec2 atlas(1 + random() % 60, 1 + random() % 60);
    RowPacker packer(atlas);
    std::vector<Box<int>> placed;
    std::uint32_t top = 0;
    for (int i = 0; i < 100; ++i) {
      const glm::uvec2 size(1 + random() % 20, 1 + random() % 20);
      const auto low = packer.place(size);
      if (!low) {
        EXPECT_TRUE(size.x > atlas.x || top + size.y > atlas.y) << "a row of its own would hold it";
        break;
      }
      const Box<int> box{glm::ivec3(*low, 0), glm::ivec3(*low + size, 1)};
      EXPECT_TRUE(Box<int>({glm::ivec3(0), glm::ivec3(atlas, 1)}).contains(box));
      for (const auto& other : placed) EXPECT_TRUE(intersection(box, other).empty());
      placed.push_back(box);
      top = std::max(top, low->y + size.y);
      EXPECT_EQ(packer.height(), top);
    }
  }
}

TEST(RowPacker, FillsRowsFromTheLowCorner) {
  RowPacker packer({10, 9});
  EXPECT_EQ(packer.place({4, 5}), glm::uvec2(0, 0));
  EXPECT_EQ(packer.place({6, 3}), glm::uvec2(4, 0));
  EXPECT_EQ(packer.place({1, 4}), glm::uvec2(0, 5));
  EXPECT_EQ(packer.place({9, 4}), glm::uvec2(1, 5));
  EXPECT_EQ(packer.height(), 9u);
  EXPECT_FALSE(packer.place({1, 1}));
  EXPECT_FALSE(RowPacker({10, 9}).place({11, 1}));
  EXPECT_FALSE(RowPacker({10, 9}).place({1, 10}));
}

}  // namespace
}  // namespace brume
