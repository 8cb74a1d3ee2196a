#include "volume/sparse_volume.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <map>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace brume::volume {
namespace {

constexpr ChannelId kDensity{0}, kColour{1};

/// One channel of two bytes a texel, one of eight.
SparseVolume make_volume(std::uint32_t max_bricks = kMaxAtlasSlots) {
  return SparseVolume({{1, 2, 3}, 0.25f, {{2}, {8}}, max_bricks});
}

/// All of one update.
template <typename Body>
void update(SparseVolume& volume, Body body) {
  volume.begin_update();
  body();
  volume.end_update();
}

std::vector<std::uint32_t> list(std::span<const std::uint32_t> slots) {
  return {slots.begin(), slots.end()};
}
using Slots = std::vector<std::uint32_t>;

bool is_zero(std::span<const std::byte> bytes) {
  return std::all_of(bytes.begin(), bytes.end(), [](std::byte b) { return b == std::byte{0}; });
}

void expect_resource_limit(const std::function<void()>& body, const std::string& number) {
  try {
    body();
    FAIL() << "no limit of " << number;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::resource_limit);
    EXPECT_NE(std::string(error.what()).find(number), std::string::npos) << error.what();
  }
}

TEST(SparseVolume, HoldsNothingAtFirst) {
  const SparseVolume volume = make_volume();
  EXPECT_EQ(volume.slot_count(), 0u);
  EXPECT_EQ(volume.channel_count(), 2u);
  EXPECT_EQ(volume.format(kColour).bytes_per_texel, 8u);
  EXPECT_EQ(volume.slot_at({0, 0, 0}), SparseVolume::kNoSlot);
  EXPECT_EQ(volume.layout().origin_world, glm::vec3(1, 2, 3));
  EXPECT_EQ(volume.layout().voxel_size, 0.25f);
  EXPECT_EQ(volume.layout().bricks.window_size, glm::ivec3(0));
  EXPECT_EQ(volume.layout().bricks.atlas_bricks, glm::ivec3(0));
  EXPECT_EQ(volume.revision(), 0u);
  EXPECT_TRUE(volume.dirty(kDensity).empty());
}

/// What a volume should hold, and what a reader has that copies only what is dirty.
struct Model {
  using Key = std::tuple<int, int, int>;
  struct Copy {
    std::vector<std::byte> density, colour;
    glm::ivec3 brick{0};
  };
  std::map<Key, std::uint32_t> slots;
  std::map<std::uint32_t, std::uint64_t> content;  // of a slot: the value of its texels
  std::vector<Copy> reader;
  std::vector<std::uint32_t> root, nodes;
  std::uint64_t generation = 0;

  static Key key(glm::ivec3 brick) { return {brick.x, brick.y, brick.z}; }
  std::set<std::uint32_t> in_use() const {
    std::set<std::uint32_t> used;
    for (const auto& [brick, slot] : slots) used.insert(slot);
    return used;
  }
  std::uint32_t lowest_free() const {
    std::uint32_t slot = 0;
    for (const std::uint32_t used : in_use()) slot += used == slot;
    return slot;
  }

  void read(const SparseVolume& volume) {
    reader.resize(volume.slot_count());
    const auto copy = [&](ChannelId channel, std::vector<std::byte> Copy::*to) {
      for (const std::uint32_t slot : volume.dirty(channel)) {
        const auto from = volume.channel(channel, slot);
        (reader[slot].*to).assign(from.begin(), from.end());
      }
    };
    copy(kDensity, &Copy::density);
    copy(kColour, &Copy::colour);
    for (const std::uint32_t slot : volume.dirty_bricks()) reader[slot].brick = volume.brick_of(slot);
    const PageTable& pages = volume.pages();
    if (pages.root_changed()) root.assign(pages.root().begin(), pages.root().end());
    nodes.resize(pages.nodes().size());
    for (const std::uint32_t node : pages.changed_nodes())
      std::copy_n(pages.nodes().begin() + node * std::ptrdiff_t{shared::kPageEntries}, shared::kPageEntries,
                  nodes.begin() + node * std::ptrdiff_t{shared::kPageEntries});
  }

  void expect_equal(const SparseVolume& volume) const {
    ASSERT_EQ(volume.slot_count(), in_use().empty() ? 0 : *in_use().rbegin() + 1);
    ASSERT_EQ(volume.layout().bricks.window_origin, volume.pages().origin());
    ASSERT_EQ(volume.layout().bricks.window_size, volume.pages().size());
    const glm::i64vec3 atlas(volume.layout().bricks.atlas_bricks);
    ASSERT_GE(atlas.x * atlas.y * atlas.z, volume.slot_count());
    for (const auto& [brick, slot] : slots) {
      const glm::ivec3 at(std::get<0>(brick), std::get<1>(brick), std::get<2>(brick));
      ASSERT_EQ(volume.slot_at(at), slot);
      ASSERT_EQ(volume.brick_of(slot), at);
    }
    for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot) {
      ASSERT_EQ(volume.in_use(slot), in_use().contains(slot));
      const std::uint64_t expected = volume.in_use(slot) ? content.at(slot) : 0;
      for (const std::uint64_t texel : volume.texels<std::uint64_t>(kColour, slot))
        ASSERT_EQ(texel, expected);
      for (const std::uint16_t texel : volume.texels<std::uint16_t>(kDensity, slot))
        ASSERT_EQ(texel, expected & 0xffff);
    }
  }
  void expect_reader_equal(const SparseVolume& volume) const {
    for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot) {
      ASSERT_TRUE(std::ranges::equal(reader[slot].density, volume.channel(kDensity, slot)));
      ASSERT_TRUE(std::ranges::equal(reader[slot].colour, volume.channel(kColour, slot)));
      ASSERT_EQ(reader[slot].brick, volume.brick_of(slot));
    }
    ASSERT_TRUE(std::ranges::equal(root, volume.pages().root()));
    ASSERT_TRUE(std::ranges::equal(nodes, volume.pages().nodes()));
  }
};

/// Sets all texels of a slot in both channels.
void write(SparseVolume& volume, std::uint32_t slot, std::uint64_t value) {
  std::ranges::fill(volume.texels<std::uint64_t>(kColour, slot), value);
  std::ranges::fill(volume.texels<std::uint16_t>(kDensity, slot), static_cast<std::uint16_t>(value));
}

TEST(SparseVolume, EqualsAMapAndAReaderThatCopiesWhatIsDirty) {
  std::mt19937 random(31);
  SparseVolume volume = make_volume();
  Model model;
  const auto brick = [&] {
    return glm::ivec3(random() % 7, random() % 30, random() % 5) - glm::ivec3(3, 17, 40);
  };
  for (std::uint64_t i = 0; i < 300; ++i) {
    // Grows, shrinks, grows again.
    const unsigned acquire_of_8 = i / 75 % 2 == 0 ? 6 : 2;
    bool structural = false;
    update(volume, [&] {
      for (auto k = random() % 12; k > 0; --k) {
        const glm::ivec3 at = brick();
        const std::uint32_t slot = volume.slot_at(at);
        if (slot == SparseVolume::kNoSlot && random() % 8 < acquire_of_8) {
          const std::uint32_t expected = model.lowest_free(), taken = volume.acquire(at);
          ASSERT_EQ(taken, expected);
          ASSERT_TRUE(is_zero(volume.channel(kDensity, taken)) && is_zero(volume.channel(kColour, taken)));
          model.slots[Model::key(at)] = taken;
          model.content[taken] = random();
          write(volume, taken, model.content[taken]);
          structural = true;
        } else if (!model.slots.empty() && random() % 8 >= acquire_of_8) {
          auto victim = model.slots.begin();
          std::advance(victim, random() % model.slots.size());
          volume.release(victim->second);
          model.slots.erase(victim);
          structural = true;
        } else if (slot != SparseVolume::kNoSlot) {
          model.content[slot] = random();
          write(volume, slot, model.content[slot]);
          volume.mark_dirty(kDensity, slot);
          volume.mark_dirty(kColour, slot);
        }
      }
    });
    model.generation += structural;
    ASSERT_EQ(volume.revision(), i + 1);
    ASSERT_EQ(volume.structure_generation(), model.generation);
    model.read(volume);
    model.expect_equal(volume);
    model.expect_reader_equal(volume);
  }
  EXPECT_GT(model.generation, 100u);
  EXPECT_GT(volume.layout().bricks.atlas_bricks.x, 4);
}

TEST(SparseVolume, GivesTheLowestFreeSlotAndDropsFreeOnesAtTheEnd) {
  SparseVolume volume = make_volume();
  update(volume, [&] {
    for (int i = 0; i < 6; ++i) EXPECT_EQ(volume.acquire({i, 0, 0}), static_cast<std::uint32_t>(i));
  });
  update(volume, [&] {
    for (const std::uint32_t slot : {3u, 1u, 4u}) volume.release(slot);
    EXPECT_EQ(volume.slot_count(), 6u);
    EXPECT_EQ(volume.acquire({-9, 0, 0}), 1u);
    EXPECT_EQ(volume.acquire({-9, 1, 0}), 3u);
    volume.release(3);
    volume.release(5);
    EXPECT_EQ(volume.slot_count(), 3u);
    EXPECT_EQ(volume.acquire({-9, 2, 0}), 3u);
  });
  EXPECT_EQ(list(volume.dirty_bricks()), (Slots{1, 3}));
  EXPECT_EQ(volume.brick_of(1), glm::ivec3(-9, 0, 0));
}

TEST(SparseVolume, HasDirtySlotsPerChannelUntilTheNextUpdate) {
  SparseVolume volume = make_volume();
  update(volume, [&] {
    for (int i = 0; i < 5; ++i) volume.acquire({0, i, 0});
  });
  EXPECT_EQ(list(volume.dirty(kDensity)), (Slots{0, 1, 2, 3, 4}));
  EXPECT_EQ(list(volume.dirty(kColour)), (Slots{0, 1, 2, 3, 4}));
  update(volume, [&] {
    volume.mark_dirty(kDensity, 4);
    volume.mark_dirty(kDensity, 2);
    volume.mark_dirty(kDensity, 4);
    volume.mark_dirty(kColour, 0);
  });
  EXPECT_EQ(list(volume.dirty(kDensity)), (Slots{2, 4}));
  EXPECT_EQ(list(volume.dirty(kColour)), (Slots{0}));
  EXPECT_TRUE(volume.dirty_bricks().empty());
  EXPECT_TRUE(volume.pages().changed_nodes().empty());
  EXPECT_EQ(volume.structure_generation(), 1u);

  // A released slot is dirty as long as it is below slot_count.
  update(volume, [&] {
    volume.release(1);
    volume.release(4);
  });
  EXPECT_EQ(list(volume.dirty(kColour)), (Slots{1}));
  EXPECT_TRUE(is_zero(volume.channel(kColour, 1)));
  update(volume, [] {});
  EXPECT_TRUE(volume.dirty(kDensity).empty() && volume.dirty(kColour).empty());
  EXPECT_EQ(volume.revision(), 4u);
  EXPECT_EQ(volume.structure_generation(), 2u);
}

TEST(SparseVolume, AddressesEachTexelOfEachChannelOnce) {
  SparseVolume volume({{0, 0, 0}, 1, {{1}, {3}, {16}}, 10});
  update(volume, [&] {
    for (int i = 0; i < 4; ++i) volume.acquire({i, -i, 7 * i});
  });
  const std::uint8_t* before = volume.texels<std::uint8_t>(ChannelId{0}, 2).data();
  for (std::uint32_t channel = 0; channel < 3; ++channel)
    for (std::uint32_t slot = 0; slot < 4; ++slot) {
      const auto bytes = volume.channel(ChannelId{channel}, slot);
      ASSERT_EQ(bytes.size(), std::size_t{volume.format(ChannelId{channel}).bytes_per_texel} * 1000);
      std::memset(bytes.data(), static_cast<int>(16 * channel + slot + 1), bytes.size());
    }
  update(volume, [&] {
    for (int i = 4; i < 10; ++i) volume.acquire({i, 0, 0});
  });
  EXPECT_EQ(volume.texels<std::uint8_t>(ChannelId{0}, 2).data(), before) << "texels move";
  for (std::uint32_t channel = 0; channel < 3; ++channel)
    for (std::uint32_t slot = 0; slot < 4; ++slot)
      for (const std::byte byte : std::as_const(volume).channel(ChannelId{channel}, slot))
        ASSERT_EQ(byte, static_cast<std::byte>(16 * channel + slot + 1));
}

TEST(SparseVolume, FindsTheSlotsAroundABrick) {
  SparseVolume volume = make_volume();
  update(volume, [&] {
    volume.acquire({-1, -1, -1});
    volume.acquire({0, 0, 0});
    volume.acquire({0, 0, 2});
    volume.acquire({-1, 0, 1});
  });
  NeighbourSlots expected;
  expected.fill(SparseVolume::kNoSlot);
  expected[13] = 1;
  expected[0] = 0;
  expected[12 + 9] = 3;
  EXPECT_EQ(volume.slots_around({0, 0, 0}), expected);
}

TEST(SparseVolume, PublishesBoundsAndLayoutAtTheEndOfAnUpdate) {
  SparseVolume volume = make_volume();
  volume.begin_update();
  volume.acquire({-8, 0, 9});
  volume.set_bounds({-64, 0, 72}, {-56, 8, 80});
  EXPECT_EQ(volume.layout().bricks.window_size, glm::ivec3(0));
  volume.end_update();
  EXPECT_EQ(volume.layout().bricks.window_origin, glm::ivec3(-1, 0, 1));
  EXPECT_EQ(volume.layout().bricks.window_size, glm::ivec3(1));
  EXPECT_EQ(volume.layout().bricks.atlas_bricks, glm::ivec3(4));
  EXPECT_EQ(volume.layout().bounds_min, glm::vec3(-64, 0, 72));
  EXPECT_EQ(volume.layout().bounds_max, glm::vec3(-56, 8, 80));
}

TEST(SparseVolume, RefusesMoreBricksThanItMayHold) {
  SparseVolume volume = make_volume(3);
  volume.begin_update();
  for (int i = 0; i < 3; ++i) volume.acquire({i, 0, 0});
  expect_resource_limit([&] { volume.acquire({3, 0, 0}); }, " 3 bricks");
  EXPECT_EQ(volume.slot_at({3, 0, 0}), SparseVolume::kNoSlot);
  // Nothing changed: a slot that comes free can be taken.
  volume.release(1);
  EXPECT_EQ(volume.acquire({3, 0, 0}), 1u);
  volume.end_update();
  EXPECT_EQ(volume.slot_count(), 3u);
}

TEST(SparseVolume, GrowsItsAtlasForThePeakBetweenUpdatesOnlyAtTheirEnd) {
  SparseVolume volume = make_volume();
  const auto acquire = [&](int first, int end) {
    for (int i = first; i < end; ++i) volume.acquire({i % 8, i / 8 % 8, i / 64});
  };
  update(volume, [&] {
    acquire(0, 65);
    volume.release(64);
  });
  EXPECT_EQ(volume.layout().bricks.atlas_bricks, glm::ivec3(4));
  update(volume, [&] { acquire(64, 65); });
  EXPECT_EQ(volume.layout().bricks.atlas_bricks, glm::ivec3(8, 4, 4));
  update(volume, [&] {
    for (std::uint32_t slot = 65; slot-- > 0;) volume.release(slot);
  });
  EXPECT_EQ(volume.slot_count(), 0u);
  EXPECT_EQ(volume.layout().bricks.window_size, glm::ivec3(0));
  EXPECT_EQ(volume.layout().bricks.atlas_bricks, glm::ivec3(8, 4, 4)) << "an atlas never shrinks";
}

TEST(GrownAtlas, HasRoomAndNeverMoreThanA3DTexture) {
  std::mt19937 random(8);
  glm::ivec3 atlas(0);
  std::uint64_t slots = 1;
  while (slots < kMaxAtlasSlots) {
    const glm::ivec3 before = atlas;
    atlas = grown_atlas(atlas, slots);
    const glm::u64vec3 size(atlas);
    ASSERT_GE(size.x * size.y * size.z, slots);
    ASSERT_TRUE(glm::all(glm::greaterThanEqual(atlas, before)));
    for (int axis = 0; axis < 3; ++axis) ASSERT_TRUE(std::has_single_bit(static_cast<unsigned>(atlas[axis])));
    ASSERT_TRUE(glm::all(glm::lessThanEqual(atlas, glm::ivec3(kMaxAtlasBricks))));
    slots += 1 + random() % slots;
  }
  EXPECT_EQ(grown_atlas(atlas, kMaxAtlasSlots), glm::ivec3(kMaxAtlasBricks));
  expect_resource_limit([&] { grown_atlas(atlas, kMaxAtlasSlots + std::uint64_t{1}); },
                        std::to_string(kMaxAtlasSlots));
}

TEST(AtlasPosition, GivesEachSlotItsOwnPlace) {
  const glm::ivec3 atlas(4, 2, 3);
  shared::BrickLayout layout{};
  set_atlas(layout, atlas);
  std::set<std::tuple<int, int, int>> places;
  for (std::uint32_t slot = 0; slot < 24; ++slot) {
    const glm::ivec3 at(shared::atlas_brick(layout, slot));
    EXPECT_TRUE(glm::all(glm::greaterThanEqual(at, glm::ivec3(0))) && glm::all(glm::lessThan(at, atlas)));
    EXPECT_EQ(static_cast<std::uint32_t>(at.x + 4 * (at.y + 2 * at.z)), slot);
    places.insert({at.x, at.y, at.z});
  }
  EXPECT_EQ(places.size(), 24u);
}

}  // namespace
}  // namespace brume::volume
