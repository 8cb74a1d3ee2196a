#include "wire/block_coding.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <random>

namespace brume::wire {
namespace {

using glm::ivec3;
using Blocks = std::vector<sim::VoxelBlock>;

std::vector<std::byte> encoded(const BlockBounds& bounds, ivec3 near, Blocks blocks,
                               const Prediction& like = {}) {
  Encoder coder;
  const auto models = std::make_unique<BlockModels>();
  code_blocks(coder, *models, bounds, near, like, blocks);
  return coder.finish();
}

struct Decoded {
  bool whole;
  Blocks blocks;
};
Decoded decoded(const BlockBounds& bounds, ivec3 near, std::span<const std::byte> bytes,
                const Prediction& like = {}) {
  Decoder coder(bytes);
  const auto models = std::make_unique<BlockModels>();
  Decoded result{false, {}};
  code_blocks(coder, *models, bounds, near, like, result.blocks);
  result.whole = coder.at_end();
  return result;
}

Blocks without_ranks(const sim::BlockSet& set) {
  Blocks blocks(set.blocks().begin(), set.blocks().end());
  for (sim::VoxelBlock& block : blocks) block.first = 0;
  return blocks;
}

sim::BlockSet random_set(ivec3 size, double share, unsigned seed) {
  std::mt19937 random(seed);
  std::bernoulli_distribution takes(share);
  std::vector<ivec3> voxels;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x)
        if (takes(random)) voxels.push_back({x, y, z});
  return sim::BlockSet(voxels);
}

TEST(BlockCoding, RoundTripsAnySize) {
  unsigned seed = 0;
  for (const ivec3 size : {ivec3(1), ivec3(7), ivec3(33, 17, 5), ivec3(4, 64, 4), ivec3(1, 1, 200)})
    for (const double share : {0.0, 0.01, 0.3, 0.9, 1.0}) {
      const sim::BlockSet set = random_set(size, share, ++seed);
      const BlockBounds bounds{size, false, 1u << 20};
      const Blocks blocks = without_ranks(set);
      for (const ivec3 near : {ivec3(0), size / 8}) {
        const auto bytes = encoded(bounds, near, blocks);
        const Decoded back = decoded(bounds, near, bytes);
        EXPECT_TRUE(back.whole) << size.x << " " << share;
        EXPECT_EQ(back.blocks, blocks);
      }
    }
}

// Blocks at the ends of the largest grid.
TEST(BlockCoding, CoversTheWholeGrid) {
  const BlockBounds bounds{ivec3(4096), false, 1u << 20};
  Blocks blocks;
  for (const int z : {0, 1023})
    for (const int y : {0, 1023})
      for (const int x : {0, 1, 1023}) blocks.push_back({glm::i16vec3(x, y, z), 1u << (x % 7), 0});
  const Decoded back = decoded(bounds, ivec3(512), encoded(bounds, ivec3(512), blocks));
  EXPECT_TRUE(back.whole);
  EXPECT_EQ(back.blocks, blocks);
}

TEST(BlockCoding, RejectsBlocksOutsideOfTheGrid) {
  const Blocks blocks{{glm::i16vec3(1, 0, 0), ~std::uint64_t{0}, 0}};
  const BlockBounds wide{ivec3(8), false, 1u << 20};
  const auto bytes = encoded(wide, ivec3(0), blocks);
  EXPECT_TRUE(decoded(wide, ivec3(0), bytes).whole);
  EXPECT_FALSE(decoded({ivec3(4), false, 1u << 20}, ivec3(0), bytes).whole) << "no such block";
  EXPECT_FALSE(decoded({ivec3(7), false, 1u << 20}, ivec3(0), bytes).whole) << "bits beyond the grid";
  EXPECT_TRUE(decoded({ivec3(7), true, 1u << 20}, ivec3(0), bytes).whole) << "allowed for edits";
  EXPECT_FALSE(decoded({ivec3(8), false, 63}, ivec3(0), bytes).whole) << "too many voxels";
  const Blocks outside{{glm::i16vec3(-1, 0, 0), 1, 0}};
  EXPECT_FALSE(decoded(wide, ivec3(0), encoded(wide, ivec3(0), outside)).whole);
  const Blocks empty{{glm::i16vec3(1, 0, 0), 0, 0}};
  EXPECT_FALSE(decoded(wide, ivec3(0), encoded(wide, ivec3(0), empty)).whole);
}

// A false block count must not cause a large allocation: decoding fails as soon as the bits run out.
TEST(BlockCoding, AllocatesNothingForAFalseCount) {
  Encoder coder;
  BlockModels models;
  coder.number(models.count, ~std::uint64_t{0});
  const Decoded back = decoded({ivec3(4096), false, ~std::uint64_t{0}}, ivec3(0), coder.finish());
  EXPECT_FALSE(back.whole);
  EXPECT_TRUE(back.blocks.empty());
}

// Blocks similar to a known state are small, and every prediction round-trips.
TEST(BlockCoding, PredictionReducesTheSize) {
  const ivec3 size(33, 17, 5);
  const BlockBounds bounds{size, false, 1u << 20};
  const sim::BlockSet known = random_set(size, 0.5, 1), other = random_set(size, 0.5, 2);
  for (const unsigned kind : {0u, 1u}) {
    const auto alone = encoded(bounds, ivec3(0), without_ranks(known));
    const auto same = encoded(bounds, ivec3(0), without_ranks(known), {&known, kind});
    EXPECT_LT(same.size() * 4, alone.size());
    EXPECT_EQ(decoded(bounds, ivec3(0), same, {&known, kind}).blocks, without_ranks(known));
    const auto unlike = encoded(bounds, ivec3(0), without_ranks(other), {&known, kind});
    EXPECT_EQ(decoded(bounds, ivec3(0), unlike, {&known, kind}).blocks, without_ranks(other));
  }
}

std::size_t steps_size(const sim::BlockSet& set, std::span<const std::uint8_t> expected,
                       std::vector<std::uint8_t> densities) {
  Encoder encoder;
  auto models = std::make_unique<DensityModels>();
  const std::vector<std::uint8_t> given = densities;
  code_densities(encoder, *models, set, expected, densities);
  const auto bytes = encoder.finish();
  Decoder decoder(bytes);
  models = std::make_unique<DensityModels>();
  std::vector<std::uint8_t> back;
  code_densities(decoder, *models, set, expected, back);
  EXPECT_TRUE(decoder.at_end());
  EXPECT_EQ(densities, given);
  EXPECT_EQ(back, given);
  return bytes.size();
}

TEST(BlockCoding, RoundTripsAnyDensities) {
  std::mt19937 random(5);
  for (const ivec3 size : {ivec3(1), ivec3(7), ivec3(33, 17, 5)}) {
    const sim::BlockSet set = random_set(size, 0.7, 11);
    std::vector<std::uint8_t> densities(set.size()), expected(set.size());
    for (auto& b : densities) b = static_cast<std::uint8_t>(random());
    for (auto& b : expected) b = static_cast<std::uint8_t>(random());
    steps_size(set, {}, densities);
    steps_size(set, expected, densities);
  }
}

// A ramp of densities: less than two bits per voxel instead of eight; predicted, less than a tenth of a bit.
TEST(BlockCoding, SmoothDensitiesAreSmall) {
  const sim::BlockSet set = random_set(ivec3(12), 1, 1);
  std::vector<std::uint8_t> ramp(set.size());
  set.for_each(
      [&](ivec3 v, std::uint32_t rank) { ramp[rank] = static_cast<std::uint8_t>(std::min(255, 30 * v.y)); });
  EXPECT_LT(steps_size(set, {}, ramp) * 8, 2 * ramp.size());
  EXPECT_LT(steps_size(set, ramp, ramp) * 80, ramp.size());
}

TEST(BlockCoding, RoundTripsDelays) {
  std::mt19937 random(6);
  for (const std::size_t length : {0u, 1u, 7u, 1000u}) {
    std::vector<std::uint32_t> order(length);
    for (std::uint32_t i = 0; i < length; ++i) order[i] = i;
    std::shuffle(order.begin(), order.end(), random);
    std::vector<std::uint8_t> group(length);
    std::vector<std::uint16_t> delays(length);
    for (auto& g : group) g = static_cast<std::uint8_t>(random() % 3);
    for (auto& w : delays) w = static_cast<std::uint16_t>(random() % 2 == 0 ? 0 : random());
    Encoder encoder;
    auto models = std::make_unique<DelayModels>();
    code_delays(encoder, *models, order, group, delays);
    const auto bytes = encoder.finish();
    Decoder decoder(bytes);
    models = std::make_unique<DelayModels>();
    std::vector<std::uint16_t> back;
    code_delays(decoder, *models, order, group, back);
    EXPECT_TRUE(decoder.at_end());
    EXPECT_EQ(back, delays);
  }
}

}  // namespace
}  // namespace brume::wire
