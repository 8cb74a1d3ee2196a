#include "grids/mask_bricks.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <glm/gtc/packing.hpp>

#include "grids/dense_grid.hpp"

namespace brume::grids {
namespace {

constexpr glm::uvec3 kSize(17, 9, 12);

Grid mask(const std::string& name, float (*value)(glm::uvec3)) {
  DenseGrid grid{name, kSize, {glm::dvec3(-1, 2, 3), glm::dvec3(0, 4, 9)}, {}};
  for (glm::uvec3 at(0); at.z < kSize.z; ++at.z)
    for (at.y = 0; at.y < kSize.y; ++at.y)
      for (at.x = 0; at.x < kSize.x; ++at.x) grid.values.push_back(value(at));
  return to_grid(grid);
}

float first_value(glm::uvec3 at) {
  return at.x < 8 ? 0.5f : 0.0f;
}
float second_value(glm::uvec3 at) {
  return at.y % 2 == 0 ? 0.25f : 0.75f;
}

TEST(MaskBricks, AreWhereOneOfTheMasksIs) {
  const Grid first = mask("first", first_value), second = mask("second", second_value);
  const Grid* both[] = {&first, &second};
  const Grid joined = joined_masks(both).value_or_throw();
  const Grid* const only = &joined;
  const GridBox box{glm::dmat4(1), {glm::dvec3(-1, 2, 3), glm::dvec3(0, 4, 9)}, kSize};
  const DenseGrid values = resample(*only, box).value_or_throw();
  for (glm::uvec3 at(0); at.z < kSize.z; ++at.z)
    for (at.y = 0; at.y < kSize.y; ++at.y)
      for (at.x = 0; at.x < kSize.x; ++at.x)
        ASSERT_EQ(values.values[values.index(at)], std::max(first_value(at), second_value(at)));
}

TEST(MaskBricks, HoldEachMaskInItsChannel) {
  const Grid first = mask("first", first_value), second = mask("second", second_value);
  const Grid* both[] = {&first, &second};
  const Grid joined = joined_masks(both).value_or_throw();
  const BrickVolume presence = make_brick_volume(joined, {.may_be_uniform = false}).value_or_throw();
  const auto bricks = make_mask_bricks(both, presence);
  ASSERT_EQ(bricks->slot_count(), presence.volume->slot_count());
  std::size_t checked = 0;
  for (std::uint32_t slot = 0; slot < bricks->slot_count(); ++slot) {
    ASSERT_EQ(bricks->brick_of(slot), presence.volume->brick_of(slot));
    const auto texels = bricks->texels<std::uint32_t>(volume::ChannelId{0}, slot);
    for (int i = 0; i < 1000; ++i) {
      const glm::ivec3 at = 8 * bricks->brick_of(slot) - 1 + glm::ivec3(i % 10, i / 10 % 10, i / 100);
      const bool inside = glm::all(glm::greaterThanEqual(at, glm::ivec3(0))) &&
                          glm::all(glm::lessThan(at, glm::ivec3(kSize)));
      const glm::vec2 found = glm::unpackHalf2x16(texels[static_cast<std::size_t>(i)]);
      const glm::uvec3 voxel(at);
      EXPECT_EQ(found, inside ? glm::vec2(first_value(voxel), second_value(voxel)) : glm::vec2(0));
      checked += inside;
    }
  }
  EXPECT_GE(checked, std::size_t{kSize.x} * kSize.y * kSize.z);
}

TEST(MaskBricks, RefuseWhatIsNotOneVolume) {
  const Grid first = mask("first", first_value);
  Grid moved = mask("moved", second_value), whole = mask("whole", second_value);
  moved.world_from_index[3].x += 1;
  whole.type = ValueType::int32;
  for (const Grid* other : {&moved, &whole}) {
    const Grid* both[] = {&first, other};
    const auto joined = joined_masks(both);
    ASSERT_FALSE(joined);
    EXPECT_NE(joined.failure().message.find(other->name), std::string::npos);
  }
}

}  // namespace
}  // namespace brume::grids
