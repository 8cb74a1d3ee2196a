#include "passes/brick_atlas.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <random>

#include "tests/gpu/gpu_test.hpp"

namespace brume::passes {
namespace {

using volume::ChannelId;
using volume::SparseVolume;

/// A volume that is not smoke: one channel of a byte a texel, one of eight.
class BrickAtlasTest : public gpu::GpuTest {
 protected:
  static SparseVolume make_volume() { return SparseVolume({{0, 0, 0}, 1, {{1}, {8}}}); }
  static constexpr std::array kFormats{VK_FORMAT_R8_UINT, VK_FORMAT_R16G16B16A16_UINT};
  static constexpr std::array kDerived{VK_FORMAT_R32_UINT};

  /// Takes some bricks, lets others go, rewrites a few.
  void change(SparseVolume& volume, int acquire_of_8) {
    volume.begin_update();
    for (int i = 0; i < 12; ++i) {
      const glm::ivec3 brick =
          glm::ivec3(random_() % 9, random_() % 12, random_() % 5) - glm::ivec3(20, 3, 1);
      std::uint32_t slot = volume.slot_at(brick);
      const bool acquires = static_cast<int>(random_() % 8) < acquire_of_8;
      if (slot != SparseVolume::kNoSlot && !acquires) {
        volume.release(slot);
        continue;
      }
      if (slot == SparseVolume::kNoSlot && acquires) slot = volume.acquire(brick);
      if (slot == SparseVolume::kNoSlot) continue;
      const ChannelId channel{static_cast<std::uint32_t>(random_() % 2)};
      for (std::byte& byte : volume.channel(channel, slot)) byte = static_cast<std::byte>(random_());
      volume.mark_dirty(channel, slot);
    }
    volume.end_update();
  }

  BrickAtlas::Upload follow(BrickAtlas& atlas, const SparseVolume& volume) {
    return follow(atlas, std::vector{&volume});
  }
  BrickAtlas::Upload follow(BrickAtlas& atlas, const std::vector<const SparseVolume*>& volumes) {
    atlas.reserve(volumes);
    BrickAtlas::Upload done{};
    runner().run([&](gpu::Recorder& recorder) { done = atlas.record(recorder, volumes); });
    return done;
  }

  /// The texels of a slot, from those of a whole image.
  template <typename Texel>
  void expect_channel(const BrickAtlas& atlas, const SparseVolume& volume, const shared::BrickLayout& layout,
                      ChannelId channel) {
    const std::vector<Texel> image = read_back<Texel>(atlas.channel(channel));
    const glm::ivec3 size = layout.atlas_bricks * shared::kBrickTexels;
    for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot) {
      const glm::ivec3 first = glm::ivec3(shared::atlas_first_texel(layout, slot));
      const auto texels = volume.texels<Texel>(channel, slot);
      for (int row = 0; row < 100; ++row) {
        const glm::ivec3 at = first + glm::ivec3(0, row % 10, row / 10);
        const Texel* from = image.data() + at.x + std::ptrdiff_t{size.x} * (at.y + size.y * at.z);
        ASSERT_EQ(0, std::memcmp(from, texels.data() + 10 * row, 10 * sizeof(Texel)))
            << slot << " row " << row;
      }
    }
  }

  /// `at`: position of the volume in the list.
  void expect_equal(const BrickAtlas& atlas, const SparseVolume& volume, std::size_t at = 0) {
    const shared::BrickLayout& layout = atlas.layout(at);
    const volume::PageTable& pages = volume.pages();
    auto entries = read_back<std::uint32_t>(atlas.pages(),
                                            layout.first_page + pages.root().size() + pages.nodes().size());
    entries.erase(entries.begin(), entries.begin() + layout.first_page);
    EXPECT_TRUE(std::equal(pages.root().begin(), pages.root().end(), entries.begin()));
    EXPECT_TRUE(std::ranges::equal(pages.nodes(), std::span(entries).subspan(pages.root().size())));
    auto bricks = read_back<glm::ivec3>(atlas.slot_bricks(), layout.first_slot + volume.slot_count());
    bricks.erase(bricks.begin(), bricks.begin() + layout.first_slot);
    for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot)
      ASSERT_EQ(bricks[slot], volume.brick_of(slot));
    expect_channel<std::uint8_t>(atlas, volume, layout, ChannelId{0});
    expect_channel<std::uint64_t>(atlas, volume, layout, ChannelId{1});
    EXPECT_EQ(atlas.derived(0).info().size, atlas.channel(ChannelId{0}).info().size);
  }

  std::mt19937 random_{77};
};

TEST_F(BrickAtlasTest, HoldsTheVolumeAfterEachUpdate) {
  SparseVolume volume = make_volume();
  BrickAtlas atlas(context(), kFormats, kDerived);
  EXPECT_EQ(follow(atlas, volume), BrickAtlas::Upload::nothing);
  int partial = 0;
  for (int i = 0; i < 30; ++i) {
    change(volume, i < 18 ? 7 : 2);
    partial += follow(atlas, volume) == BrickAtlas::Upload::changes;
    if (volume.slot_count() > 0) expect_equal(atlas, volume);
    const shared::BrickLayout &here = atlas.layout(0), &alone = volume.layout().bricks;
    EXPECT_EQ(0, std::memcmp(&here, &alone, sizeof here)) << "alone it is where its own layout says";
    EXPECT_EQ(follow(atlas, volume), BrickAtlas::Upload::nothing);
  }
  EXPECT_GT(partial, 10) << "updates that do not grow anything upload only what changed";
  EXPECT_GT(volume.layout().bricks.atlas_bricks.x, 4) << "the atlas grew";
}

TEST_F(BrickAtlasTest, TakesEverythingAfterAMissedUpdateAndFromAnotherVolume) {
  SparseVolume volume = make_volume(), other = make_volume();
  BrickAtlas atlas(context(), kFormats, kDerived);
  change(volume, 8);
  EXPECT_EQ(follow(atlas, volume), BrickAtlas::Upload::everything);
  change(volume, 5);
  change(volume, 5);
  EXPECT_EQ(follow(atlas, volume), BrickAtlas::Upload::everything);
  expect_equal(atlas, volume);
  // Another volume with the same number of updates.
  for (int i = 0; i < 3; ++i) change(other, 8);
  EXPECT_EQ(other.revision(), volume.revision());
  EXPECT_EQ(follow(atlas, other), BrickAtlas::Upload::everything);
  expect_equal(atlas, other);
}

TEST_F(BrickAtlasTest, HoldsSeveralVolumesThatComeGrowAndGo) {
  std::array<SparseVolume, 4> volumes{make_volume(), make_volume(), make_volume(), make_volume()};
  BrickAtlas atlas(context(), kFormats, kDerived);
  int partial = 0;
  for (int i = 0; i < 40; ++i) {
    std::vector<const SparseVolume*> list;
    for (SparseVolume& volume : volumes) {
      if (random_() % 3 == 0) change(volume, i < 25 ? 6 : 2);
      if (i % 8 < 6 || random_() % 2 == 0) list.push_back(&volume);
    }
    partial += follow(atlas, list) == BrickAtlas::Upload::changes;
    for (std::size_t at = 0; at < list.size(); ++at)
      if (list[at]->slot_count() > 0) expect_equal(atlas, *list[at], at);
    EXPECT_EQ(follow(atlas, list), BrickAtlas::Upload::nothing);
  }
  EXPECT_GT(partial, 5) << "volumes that do not move upload only what changed";
}

}  // namespace
}  // namespace brume::passes
