// Glass and grilles in event logs, packets and replays.
#include <gtest/gtest.h>

#include "core/box.hpp"
#include "tests/wire/busy_world.hpp"
#include "wire/archive.hpp"
#include "wire/event_log.hpp"
#include "wire/packet.hpp"
#include "wire/replay.hpp"
#include "wire/state_coding.hpp"

namespace brume::wire {
namespace {

using glm::ivec3;
using sim::EditBlock;
using sim::EditBlocks;

/// A random role for some of the voxels of a box.
EditBlocks random_edit(const voxel::GridLayout& layout, ivec3 low, ivec3 high, std::mt19937& random) {
  EditBlocks edits = sim::edit_box(layout, low, high, true);
  for (EditBlock& block : edits) {
    const std::uint64_t within = block.make_solid, a = random() | std::uint64_t{random()} << 32,
                        b = random() | std::uint64_t{random()} << 32;
    block = {block.at, within & a & b, within & a & ~b, within & ~a & b, within & ~a & ~b};
  }
  std::erase_if(edits, [](const EditBlock& block) { return block.all() == 0; });
  return edits;
}

/// A busy match with panes and grilles that come and go.
std::vector<sim::Event> match_with_roles(const voxel::BitGrid& level, unsigned seed) {
  std::vector<sim::Event> events = busy_match(level, seed, 300, 300);
  std::mt19937 random(seed);
  for (std::uint32_t tick = 20; tick < 300; tick += 20) {
    const ivec3 low = free_voxel(level, random) - ivec3(2);
    events.push_back(sim::LevelEdit{tick, random_edit(level.layout(), low, low + ivec3(3, 5, 7), random)});
  }
  return events;
}

TEST(RoleCoding, FoldedListsUnfold) {
  const voxel::GridLayout layout{ivec3(24), 0.5f, glm::vec3(0)};
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    const ivec3 low(random() % 20, random() % 20, random() % 20);
    const EditBlocks edits = random_edit(layout, low, low + ivec3(1 + i % 7, 3, 5), random);
    EXPECT_EQ(unfolded(folded(edits)), edits);
  }
  EXPECT_FALSE(unfolded({{glm::i16vec3(0), 1, 0, 0, 1}})) << "a grille that is not in both lists";
}

TEST(RoleCoding, EventLogsRoundTrip) {
  for (const ivec3 size : {ivec3(33, 17, 5), ivec3(40, 16, 40), ivec3(7)}) {
    const voxel::BitGrid level = yard(size);
    const auto events = match_with_roles(level, 7);
    const auto bytes = write_events(events, level.layout());
    const auto back = read_events(bytes, level.layout()).value_or_throw();
    EXPECT_EQ(back, events);
    for (std::size_t length = 0; length < bytes.size(); length += 11)
      EXPECT_FALSE(read_events(std::span<const std::byte>(bytes).first(length), level.layout())) << length;
  }
}

TEST(RoleCoding, KeyframesAndDeltasRoundTrip) {
  const voxel::BitGrid level = rooms(5, {40, 8, 40});
  sim::World world = world_of(level, match_with_roles(level, 5));
  const auto read = [](std::span<const std::byte> packet, const sim::State* base) {
    const auto head = read_head(packet, {});
    return base ? read_delta(*head, *base, {}) : read_keyframe(*head, {});
  };
  sim::State last = *read(write_keyframe(world.state()), nullptr);
  std::size_t with_roles = 0;
  for (std::uint32_t tick = 1; tick <= 310; ++tick) {
    world.advance_to(tick);
    auto next = read(write_delta(last, world.state()), &last);
    ASSERT_TRUE(next) << "tick " << tick << ": " << next.failure().message;
    ASSERT_EQ(next->hash(), world.state_hash()) << tick;
    if (tick % 30 == 0) {
      const auto whole = read(write_keyframe(world.state()), nullptr).value_or_throw();
      ASSERT_EQ(whole.hash(), world.state_hash()) << tick;
    }
    last = std::move(*next);
    if (last.edits) with_roles += std::ranges::any_of(*last.edits, &EditBlock::has_roles);
  }
  EXPECT_GT(with_roles, 200u);
  // What was received is a level as well.
  sim::World other(level, kBusySettings);
  other.restore(last).value_or_throw();
  int differing = 0;
  for_each_in(Box<int>{ivec3(0), level.size()},
              [&](ivec3 v) { differing += other.solids().role(v) != world.solids().role(v); });
  EXPECT_EQ(differing, 0);
}

TEST(RoleCoding, ReplaysHaveTheRolesOfTheirLevel) {
  voxel::BitGrid grid = rooms(3, {40, 8, 40});
  std::mt19937 random(3);
  voxel::RoleGrids roles{grid, grid};
  // Panes are in the grid and no obstacle to sight, grilles are obstacles to bodies alone.
  fill_box(grid, {20, 1, 1}, {21, 6, 30}, true);
  fill_box(*roles.bodies, {20, 1, 1}, {21, 6, 30}, true);
  fill_box(*roles.bodies, {30, 1, 1}, {31, 6, 30}, true);
  const voxel::Solids level(grid, roles);
  Replay replay = make_replay(level, kBusySettings, match_with_roles(grid, 3));
  sim::World world(level, kBusySettings);
  world.append(replay.events).value_or_throw();
  for (std::uint32_t tick = 0; tick < 200; ++tick) {
    world.advance_to(tick);
    replay.checksums.push_back(checksum_of(world.state()));
  }
  const auto bytes = encode_replay(replay).value_or_throw();
  const auto back = decode_replay(bytes).value_or_throw();
  const voxel::Solids got(back.level, back.roles);
  int differing = 0;
  for_each_in(Box<int>{ivec3(0), grid.size()}, [&](ivec3 v) { differing += got.role(v) != level.role(v); });
  EXPECT_EQ(differing, 0);
  EXPECT_EQ(got.role({20, 3, 5}), Role::glass);
  EXPECT_FALSE(play(back).value_or_throw()) << "a tick differs";
  EXPECT_EQ(encode_replay(back).value_or_throw(), bytes);
  for (std::size_t length = 0; length < bytes.size(); length += 7)
    EXPECT_FALSE(decode_replay(std::span<const std::byte>(bytes).first(length))) << length;
}

}  // namespace
}  // namespace brume::wire
