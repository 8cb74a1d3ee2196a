#include "wire/block_coding.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <random>

namespace brume::wire {
namespace {

using glm::ivec3;
using Blocks = std::vector<sim::VoxelBlock>;

std::vector<std::byte> encoded(const BlockBounds& bounds, ivec3 near, Blocks blocks) {
  Encoder coder;
  const auto models = std::make_unique<BlockModels>();
  code_blocks(coder, *models, bounds, near, blocks);
  return coder.finish();
}

struct Decoded {
  bool whole;
  Blocks blocks;
};
Decoded decoded(const BlockBounds& bounds, ivec3 near, std::span<const std::byte> bytes) {
  Decoder coder(bytes);
  const auto models = std::make_unique<BlockModels>();
  Decoded result{false, {}};
  code_blocks(coder, *models, bounds, near, result.blocks);
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

TEST(BlockCoding, ReadsWhatItWroteOfAnySize) {
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
TEST(BlockCoding, ReachesTheWholeGrid) {
  const BlockBounds bounds{ivec3(4096), false, 1u << 20};
  Blocks blocks;
  for (const int z : {0, 1023})
    for (const int y : {0, 1023})
      for (const int x : {0, 1, 1023}) blocks.push_back({glm::i16vec3(x, y, z), 1u << (x % 7), 0});
  const Decoded back = decoded(bounds, ivec3(512), encoded(bounds, ivec3(512), blocks));
  EXPECT_TRUE(back.whole);
  EXPECT_EQ(back.blocks, blocks);
}

TEST(BlockCoding, RefusesWhatLiesOutside) {
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

// A count says how many blocks there are, not how much memory to take: without their bits it ends at once.
TEST(BlockCoding, DoesNotTrustACount) {
  Encoder coder;
  BlockModels models;
  coder.number(models.count, ~std::uint64_t{0});
  const Decoded back = decoded({ivec3(4096), false, ~std::uint64_t{0}}, ivec3(0), coder.finish());
  EXPECT_FALSE(back.whole);
  EXPECT_TRUE(back.blocks.empty());
}

template <typename Step>
void check_steps(const sim::BlockSet& set, const std::vector<Step>& steps) {
  Encoder encoder;
  auto models = std::make_unique<StepModels>();
  std::vector<Step> copy = steps;
  code_steps(encoder, *models, set, copy);
  EXPECT_EQ(copy, steps);
  const auto bytes = encoder.finish();
  Decoder decoder(bytes);
  models = std::make_unique<StepModels>();
  std::vector<Step> back;
  code_steps(decoder, *models, set, back);
  EXPECT_TRUE(decoder.at_end());
  EXPECT_EQ(back, steps);
}

TEST(BlockCoding, StepsOfAnyValuesReturn) {
  std::mt19937 random(5);
  for (const ivec3 size : {ivec3(1), ivec3(7), ivec3(33, 17, 5)}) {
    const sim::BlockSet set = random_set(size, 0.7, 11);
    std::vector<std::uint8_t> bytes(set.size());
    std::vector<std::uint16_t> words(set.size());
    for (auto& b : bytes) b = static_cast<std::uint8_t>(random());
    for (auto& w : words) w = static_cast<std::uint16_t>(random());
    check_steps(set, bytes);
    check_steps(set, words);
  }
}

// A ramp of densities, as an edit leaves them: less than two bits a voxel, not eight.
TEST(BlockCoding, SmoothStepsAreSmall) {
  const sim::BlockSet set = random_set(ivec3(12), 1, 1);
  std::vector<std::uint8_t> ramp(set.size());
  set.for_each(
      [&](ivec3 v, std::uint32_t rank) { ramp[rank] = static_cast<std::uint8_t>(std::min(255, 30 * v.y)); });
  Encoder coder;
  const auto models = std::make_unique<StepModels>();
  code_steps(coder, *models, set, ramp);
  EXPECT_LT(coder.finish().size() * 8, 2 * ramp.size());
}

}  // namespace
}  // namespace brume::wire
