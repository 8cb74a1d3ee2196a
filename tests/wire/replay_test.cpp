#include "wire/replay.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "core/file.hpp"
#include "core/hash.hpp"
#include "sim/event_fields.hpp"
#include "tests/sim/random_events.hpp"
#include "tests/wire/busy_world.hpp"
#include "tests/work_folder.hpp"
#include "wire/event_log.hpp"
#include "wire/packet.hpp"

namespace brume::wire {
namespace {

using Bytes = std::vector<std::byte>;

Replay recorded(const voxel::BitGrid& level, const std::vector<sim::Event>& events, std::uint32_t ticks) {
  Replay replay = make_replay(level, kBusySettings, events);
  sim::World world = world_of(level, events);
  for (std::uint32_t tick = 0; tick < ticks; ++tick) {
    world.advance_to(tick);
    replay.checksums.push_back(checksum_of(world.state()));
  }
  return replay;
}

TEST(EventLog, RoundTripsABusyMatch) {
  const voxel::BitGrid level = rooms(1);
  for (unsigned seed = 0; seed < 20; ++seed) {
    const auto events = busy_match(level, seed, 1000, 1800);
    const Bytes bytes = write_events(events, level.layout());
    const auto back = read_events(bytes, level.layout()).value_or_throw();
    EXPECT_EQ(back, events);
  }
  const auto none = read_events(write_events({}, level.layout()), level.layout());
  ASSERT_TRUE(none);
  EXPECT_TRUE(none->empty());
}

TEST(EventLog, RoundTripsEventsOfEveryKind) {
  const voxel::GridLayout layout = yard({40, 16, 40}).layout();
  for (unsigned seed = 0; seed < 20; ++seed) {
    const auto events = sim::random_events(seed, layout, 30, 1000);
    EXPECT_EQ(read_events(write_events(events, layout), layout).value_or_throw(), events);
  }
}

TEST(EventLog, RejectsEventsThatTheWorldRejects) {
  const voxel::GridLayout layout{glm::ivec3(16), 0.5f, glm::vec3(0)};
  const auto refused = [&](const sim::Event& event) {
    EXPECT_FALSE(sim::check_event(event, layout));
    const auto got = read_events(write_events({&event, 1}, layout), layout);
    return !got && got.failure().code == ErrorCode::bad_input;
  };
  EXPECT_TRUE(refused(sim::ThrowSmoke{sim::kMaxTick + 1, {}, {}, {}}));
  EXPECT_TRUE(refused(sim::ThrowSmoke{0, {}, {}, {.voxels = 0}}));
  EXPECT_TRUE(refused(sim::Shot{0, {}, {}, 205, {}}));
  EXPECT_TRUE(refused(sim::Shot{0, {}, {1 << 25, 0, 0}, 205, {}}));
  EXPECT_TRUE(refused(sim::Shot{0, {}, {1, 0, 0}, 205, {}, static_cast<sim::HoleShape>(3)}));
  EXPECT_TRUE(refused(sim::Shot{0, {}, {1, 0, 0}, 205, {}, sim::HoleShape::box, 1}));
  EXPECT_TRUE(refused(sim::Shot{0, {}, {1, 0, 0}, 205, {}, sim::HoleShape::mask, sim::kMaxMasks}));
  EXPECT_TRUE(refused(sim::Shot{0, {}, {1, 0, 0}, 205, {}, sim::HoleShape::box, 0, sim::kFullTurn}));
  EXPECT_TRUE(refused(sim::Blast{0, {}, 0}));
  EXPECT_TRUE(refused(sim::MoveBody{0, 0, {std::numeric_limits<int>::min(), 0, 0}}));
  EXPECT_TRUE(refused(sim::LevelEdit{0, {{glm::i16vec3(9, 0, 0), 1, 0}}}));
}

TEST(EventLog, RejectsDamage) {
  const voxel::BitGrid level = yard({16, 8, 16});
  const auto events = busy_match(level, 3, 1000, 1800);
  const Bytes bytes = write_events(events, level.layout());
  for (std::size_t length = 0; length < bytes.size(); length += 3) {
    const auto got = read_events(std::span<const std::byte>(bytes).first(length), level.layout());
    EXPECT_FALSE(got) << length;
  }
  EXPECT_FALSE(read_events(bytes, level.layout(), {.max_items = events.size() - 1}));
}

TEST(Replay, RoundTripsAndPlays) {
  for (const glm::ivec3 size : {glm::ivec3(33, 17, 5), glm::ivec3(40, 16, 40), glm::ivec3(7)}) {
    const voxel::BitGrid level = yard(size);
    const Replay replay = recorded(level, busy_match(level, 1, 200, 100), 250);
    const auto bytes = encode_replay(replay);
    ASSERT_TRUE(bytes);
    const auto back = decode_replay(*bytes).value_or_throw();
    EXPECT_EQ(back.events, replay.events);
    EXPECT_EQ(back.checksums, replay.checksums);
    EXPECT_EQ(back.level.layout(), level.layout());
    EXPECT_EQ(back.settings.masks, kBusySettings.masks);
    EXPECT_TRUE(sim::difference(back.level, level, glm::ivec3(0), size).empty());
    std::uint32_t ticks = 0;
    const auto divergence = play(back, [&](const sim::State& state) { EXPECT_EQ(state.tick, ticks++); });
    ASSERT_TRUE(divergence);
    EXPECT_FALSE(*divergence);
    EXPECT_EQ(ticks, 250u);
    EXPECT_EQ(*encode_replay(back), *bytes);
  }
}

TEST(Replay, RejectsOtherMasks) {
  const voxel::BitGrid level = yard({20, 9, 20});
  const Replay replay = recorded(level, busy_match(level, 1, 20, 30), 30);
  Replay other = replay;
  other.settings.masks.hash += 1;
  const auto divergence = play(other);
  ASSERT_TRUE(divergence && *divergence);
  EXPECT_EQ((*divergence)->tick, 0u);
  Replay none = replay;
  none.settings.masks = {};
  const auto refused = play(none);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.failure().message.find("in a world with 0; set WorldSettings::masks"), std::string::npos);
}

TEST(Replay, NamesTheFirstTickThatDiffers) {
  const voxel::BitGrid level = yard({20, 9, 20});
  Replay replay = recorded(level, {sim::MoveBody{10, 0, {}}, sim::MoveBody{20, 0, {5, 0, 0}}}, 50);
  std::get<sim::MoveBody>(replay.events[1]).to.x = 6;
  const auto divergence = play(replay);
  ASSERT_TRUE(divergence && *divergence);
  EXPECT_EQ((*divergence)->tick, 20u);
  EXPECT_EQ((*divergence)->recorded, replay.checksums[20]);
  EXPECT_NE((*divergence)->got, replay.checksums[20]);
}

TEST(Replay, RejectsDamage) {
  const voxel::BitGrid level = yard({12, 6, 12});
  const Bytes bytes = *encode_replay(recorded(level, busy_match(level, 1, 20, 30), 30));
  for (std::size_t length = 0; length < bytes.size(); ++length)
    EXPECT_FALSE(decode_replay(std::span<const std::byte>(bytes).first(length))) << length;
  // Damage with a matching final hash.
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    Bytes damaged(bytes.begin(), bytes.end() - 8);
    damaged[random() % damaged.size()] = static_cast<std::byte>(random());
    const std::uint64_t hash = hash_bytes(damaged);
    for (int k = 0; k < 8; ++k) damaged.push_back(static_cast<std::byte>(hash >> (8 * k)));
    const auto got = decode_replay(damaged);
    if (!got) {
      EXPECT_EQ(got.failure().code, ErrorCode::bad_input);
    }
  }
}

TEST(Replay, FileErrorsNameTheFile) {
  const cli::WorkFolder work_folder;
  const auto folder = work_folder.path();
  const voxel::BitGrid level = yard({12, 6, 12});
  const Replay replay = recorded(level, {}, 5);
  ASSERT_TRUE(save_replay(folder / "a.brp", replay));
  const auto back = load_replay(folder / "a.brp");
  ASSERT_TRUE(back);
  EXPECT_EQ(back->checksums, replay.checksums);
  ASSERT_TRUE(write_file_atomic(folder / "b.brp", std::string("BRUMERPL")));
  const auto bad = load_replay(folder / "b.brp");
  ASSERT_FALSE(bad);
  EXPECT_NE(bad.failure().message.find("b.brp"), std::string::npos);
  EXPECT_FALSE(load_replay(folder / "none.brp"));
  EXPECT_FALSE(save_replay(folder / "none" / "a.brp", replay));
}

}  // namespace
}  // namespace brume::wire
