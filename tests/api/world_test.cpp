// Worlds, states and packets through the C interface: the same bits as the simulation below it, in any order
// of calls.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <variant>

#include "sim/world.hpp"
#include "tests/api/event_structs.hpp"
#include "tests/api/match.hpp"
#include "tests/sim/random_events.hpp"
#include "voxel/voxelize.hpp"

namespace brume::api {
namespace {

class WorldTest : public testing::Test {
 protected:
  World world(std::uint32_t ticks_per_second = 64) const {
    brume_world_params params = brume_world_defaults();
    params.ticks_per_second = ticks_per_second;
    params.masks = masks_.get();
    return World(level_, params);
  }
  World played() const {
    World world = this->world();
    world.append(match_.events);
    return world;
  }
  /// The hashes of every tick, straight.
  std::vector<std::uint64_t> hashes() const {
    World world = played();
    std::vector<std::uint64_t> hashes;
    for (std::uint32_t tick = 0; tick < Match::kTicks; ++tick) {
      world.advance_to(tick);
      hashes.push_back(world.hash());
    }
    return hashes;
  }

  Match match_;
  Context context_;
  Level level_ = match_.level(context_);
  Masks masks_ = match_.masks(context_);
};

brume_result result_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.result();
  }
  return BRUME_OK;
}

TEST_F(WorldTest, HasTheHashesOfTheSimulation) {
  const voxel::BitGrid grid = *voxel::voxelize(match_.triangles(), match_.grid_layout());
  sim::World expected = match_.sim_world(grid);
  World world = played();
  std::size_t clouds = 0;
  for (std::uint32_t tick = 0; tick < Match::kTicks; ++tick) {
    expected.advance_to(tick);
    world.advance_to(tick);
    ASSERT_EQ(world.hash(), expected.state_hash()) << tick;
    clouds = std::max<std::size_t>(clouds, world.state().describe().cloud_count);
  }
  EXPECT_GE(clouds, 3u);
}

TEST_F(WorldTest, ListsWhatAStateHolds) {
  const voxel::BitGrid grid = *voxel::voxelize(match_.triangles(), match_.grid_layout());
  sim::World expected = match_.sim_world(grid);
  World world = played();
  std::size_t grenades = 0, blasts = 0;
  for (std::uint32_t tick = 0; tick < Match::kTicks; tick += 3) {
    expected.advance_to(tick);
    world.advance_to(tick);
    const State state = world.state();
    const sim::State& truth = expected.state();
    const auto clouds = state.clouds();
    ASSERT_EQ(clouds.size(), truth.clouds.size());
    for (std::size_t i = 0; i < clouds.size(); ++i) {
      EXPECT_EQ(clouds[i].id, truth.clouds[i].id);
      EXPECT_EQ(clouds[i].end_tick, truth.clouds[i].cloud->end_tick());
      EXPECT_EQ(clouds[i].low.y, truth.clouds[i].cloud->low().y);
      EXPECT_EQ(clouds[i].high.z, truth.clouds[i].cloud->high().z + 1);
    }
    const auto holes = state.holes();
    ASSERT_EQ(holes.size(), truth.holes.size());
    for (std::size_t i = 0; i < holes.size(); ++i) {
      EXPECT_EQ(holes[i].distance_1024, truth.holes[i].distance);
      EXPECT_EQ(holes[i].toward.z, truth.holes[i].shot.toward.z);
    }
    const auto bodies = state.bodies();
    ASSERT_EQ(bodies.size(), truth.bodies.size());
    for (std::size_t i = 0; i < bodies.size(); ++i)
      EXPECT_EQ(bodies[i].previous_position.x, truth.bodies[i].previous.x);
    const auto in_air = state.grenades();
    ASSERT_EQ(in_air.size(), truth.flights.size());
    for (std::size_t i = 0; i < in_air.size(); ++i) {
      EXPECT_EQ(in_air[i].position.x, sim::grenades_of(truth)[i].position_world.x);
      EXPECT_EQ(in_air[i].landing.x, truth.flights[i].landing.x);
    }
    ASSERT_EQ(state.blasts().size(), truth.blasts.size());
    grenades += in_air.size();
    blasts += truth.blasts.size();
    const brume_state_info info = state.describe();
    EXPECT_EQ(info.hole_count, holes.size());
    EXPECT_EQ(info.body_count, bodies.size());
    EXPECT_EQ(info.event_count, truth.events);
  }
  EXPECT_GT(grenades, 5u);
  EXPECT_GT(blasts, 50u);
}

TEST_F(WorldTest, TakesEventsOfEveryKind) {
  const voxel::BitGrid grid = *voxel::voxelize(match_.triangles(), match_.grid_layout());
  sim::World expected = match_.sim_world(grid);
  World world = played();
  for (const sim::Event& event : sim::random_events(1, match_.grid_layout(), 12, Match::kTicks)) {
    if (std::holds_alternative<sim::LevelEdit>(event)) continue;  // only the match has edits
    expected.append(event).value_or_throw();
    world.append(c_event(event));
  }
  for (std::uint32_t tick = 0; tick < Match::kTicks; tick += 5) {
    expected.advance_to(tick);
    world.advance_to(tick);
    ASSERT_EQ(world.hash(), expected.state_hash()) << tick;
  }
}

TEST_F(WorldTest, LateEventsGiveTheStatesOfEventsInTime) {
  const auto expected = hashes();
  World world = this->world();
  std::vector<brume_event> late = match_.events;
  std::mt19937 random(7);
  for (std::uint32_t tick = 0; tick < Match::kTicks + 40; ++tick) {
    world.advance_to(tick);
    // Each event comes up to 40 ticks late, in the order of the log within its tick.
    const auto arrived = std::stable_partition(late.begin(), late.end(), [&](const brume_event& event) {
      return event.tick + event.tick % 41 > tick;
    });
    world.append(std::vector<brume_event>(arrived, late.end()));
    late.erase(arrived, late.end());
  }
  ASSERT_TRUE(late.empty());
  for (std::uint32_t round = 0; round < 60; ++round) {
    const auto tick = static_cast<std::uint32_t>(random() % Match::kTicks);
    world.advance_to(tick);
    ASSERT_EQ(world.hash(), expected[tick]) << tick;
  }
}

TEST_F(WorldTest, ReplacedPredictionsLeaveNoTrace) {
  const auto expected = hashes();
  World world = played();
  world.advance_to(300);
  // A prediction without the events from tick 203 on, then the truth.
  world.replace_from(203, {});
  EXPECT_NE(world.hash(), expected[300]);
  std::vector<brume_event> tail;
  std::copy_if(match_.events.begin(), match_.events.end(), std::back_inserter(tail),
               [](const brume_event& event) { return event.tick >= 203; });
  world.replace_from(203, tail);
  EXPECT_EQ(world.hash(), expected[300]);
  EXPECT_EQ(result_of([&] { world.replace_from(204, tail); }), BRUME_ERROR_ARGUMENT);
  EXPECT_EQ(world.hash(), expected[300]);
}

TEST_F(WorldTest, SnapshotsOfBytesContinueTheMatch) {
  const auto expected = hashes();
  World world = played();
  for (const std::uint32_t tick : {0u, 70u, 200u, 333u}) {
    world.advance_to(tick);
    const State state = world.state();
    const Bytes bytes = state.save();
    const State loaded(context_, bytes);
    EXPECT_EQ(loaded.hash(), expected[tick]);
    EXPECT_EQ(loaded.save(), bytes);

    World other = played();
    other.restore(loaded);
    EXPECT_EQ(other.tick(), tick);
    EXPECT_EQ(other.earliest_tick(), tick);
    for (std::uint32_t later = tick; later < Match::kTicks; later += 9) {
      other.advance_to(later);
      ASSERT_EQ(other.hash(), expected[later]) << later;
    }
  }
}

TEST_F(WorldTest, SmallBuffersAreRejectedAndUntouched) {
  World world = played();
  world.advance_to(200);
  const State state = world.state();
  const Bytes bytes = state.save();
  ASSERT_GT(bytes.size(), 20u);
  Bytes small(bytes.size() - 1, 0xaa);
  std::size_t size = 0;
  EXPECT_EQ(brume_state_save(state.get(), small.data(), small.size(), &size), BRUME_ERROR_BUFFER);
  EXPECT_EQ(size, bytes.size());
  EXPECT_EQ(small, Bytes(bytes.size() - 1, 0xaa));
  Bytes large(bytes.size() + 3, 0xaa);
  EXPECT_EQ(brume_state_save(state.get(), large.data(), large.size(), &size), BRUME_OK);
  EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), large.begin()));
  EXPECT_EQ(large.back(), 0xaa);
}

TEST_F(WorldTest, DroppedHistoryIsReported) {
  World world = played();
  for (std::uint32_t tick = 0; tick < 300; ++tick) {
    world.advance_to(tick);
    if (tick > 64) world.forget_before(tick - 64);
  }
  EXPECT_EQ(world.earliest_tick(), 235u);
  const std::uint64_t hash = world.hash();
  EXPECT_EQ(result_of([&] { world.append(brume_event_defaults(BRUME_EVENT_MOVE, 234)); }),
            BRUME_ERROR_HISTORY);
  EXPECT_EQ(result_of([&] { world.replace_from(234, {}); }), BRUME_ERROR_HISTORY);
  EXPECT_EQ(result_of([&] { world.advance_to(234); }), BRUME_ERROR_HISTORY);
  EXPECT_EQ(world.hash(), hash);
  EXPECT_EQ(world.tick(), 299u);
  world.append(brume_event_defaults(BRUME_EVENT_MOVE, 235));
  EXPECT_NE(world.hash(), hash);

  // After a restored state, too.
  World restored = this->world();
  restored.restore(world.state());
  EXPECT_EQ(result_of([&] { restored.append(brume_event_defaults(BRUME_EVENT_MOVE, 299)); }),
            BRUME_ERROR_HISTORY);
  restored.forget_before(200);
  EXPECT_EQ(restored.earliest_tick(), 299u);
  restored.append(brume_event_defaults(BRUME_EVENT_MOVE, 300));
}

TEST_F(WorldTest, StatesOfOtherWorldsAreMismatched) {
  World world = this->world(), faster = this->world(128), plain(level_);
  EXPECT_EQ(result_of([&] { world.restore(faster.state()); }), BRUME_ERROR_MISMATCH);
  EXPECT_EQ(result_of([&] { world.restore(plain.state()); }), BRUME_ERROR_MISMATCH);
  EXPECT_EQ(result_of([&] { plain.append(match_.events); }), BRUME_ERROR_ARGUMENT) << "shots with masks";
  EXPECT_EQ(plain.state().describe().event_count, 0u) << "all or none";
}

TEST_F(WorldTest, OwnersMayBeDestroyedFirst) {
  const auto expected = hashes();
  std::optional<Context> context(std::in_place);
  std::optional<Level> level(match_.level(*context));
  std::optional<Masks> masks(match_.masks(*context));
  brume_world_params params = brume_world_defaults();
  params.masks = masks->get();
  World world(*level, params);
  context.reset(), level.reset(), masks.reset();
  world.append(match_.events);
  world.advance_to(250);
  EXPECT_EQ(world.hash(), expected[250]);
}

TEST_F(WorldTest, ReceiversHaveTheSendersStates) {
  World world = played();
  Sender sender(context_);
  Receiver receiver(context_), late(context_);
  EXPECT_TRUE(receiver.behind());
  EXPECT_EQ(result_of([&] { (void)receiver.state(); }), BRUME_ERROR_ORDER);
  EXPECT_EQ(result_of([&] { (void)sender.packet(); }), BRUME_ERROR_ORDER);
  std::mt19937 random(3);
  std::uint32_t lost = 0;
  for (std::uint32_t tick = 0; tick < Match::kTicks; ++tick) {
    world.advance_to(tick);
    const Bytes packet = sender.push(world.state());
    // Half of the packets are lost; a request gets what is missing.
    if (random() % 2 == 0) {
      receiver.receive(packet);
      if (receiver.behind()) {
        ++lost;
        receiver.receive(sender.answer(receiver.request()));
      }
      ASSERT_FALSE(receiver.behind());
      ASSERT_EQ(receiver.state().hash(), world.hash()) << tick;
      EXPECT_EQ(receiver.receive(packet), BRUME_RECEPTION_OLD);
      EXPECT_TRUE(sender.answer(receiver.request()).empty()) << "up to date";
    }
    if (tick == 200) {
      EXPECT_EQ(late.receive(packet), BRUME_RECEPTION_MISSED);
    }
  }
  EXPECT_GT(lost, 20u);
  EXPECT_EQ(late.receive(sender.answer(late.request())), BRUME_RECEPTION_APPLIED);
  EXPECT_EQ(late.state().hash(), world.hash());
  EXPECT_EQ(result_of([&] { sender.push(world.state()); }), BRUME_ERROR_ORDER);

  // Damaged bytes change nothing.
  Bytes damaged = world.state().save();
  damaged[damaged.size() / 2] ^= 1;
  EXPECT_EQ(result_of([&] { late.reset(), late.receive(damaged); }), BRUME_ERROR_DATA);
  EXPECT_EQ(result_of([&] { State(context_, damaged); }), BRUME_ERROR_DATA);
  EXPECT_EQ(result_of([&] { sender.answer(damaged); }), BRUME_ERROR_DATA);
  EXPECT_TRUE(late.behind());
}

TEST_F(WorldTest, ReceiversHoldEarlyPackets) {
  World world = played();
  Sender sender(context_);
  std::vector<Bytes> packets;
  for (std::uint32_t tick = 0; tick < 4; ++tick) {
    world.advance_to(tick);
    packets.push_back(sender.push(world.state()));
  }
  brume_receiver_params params = brume_receiver_defaults();
  params.hold_ticks = 2;
  Receiver receiver(context_, params);
  EXPECT_EQ(receiver.receive(packets[0]), BRUME_RECEPTION_APPLIED);
  EXPECT_EQ(receiver.receive(packets[2]), BRUME_RECEPTION_HELD);
  EXPECT_EQ(receiver.receive(packets[3]), BRUME_RECEPTION_HELD);
  EXPECT_FALSE(receiver.behind());
  EXPECT_EQ(receiver.state().describe().tick, 0u);
  EXPECT_EQ(receiver.receive(packets[1]), BRUME_RECEPTION_APPLIED);
  EXPECT_EQ(receiver.state().hash(), world.hash());

  params.hold_ticks = 65;
  EXPECT_EQ(result_of([&] { Receiver(context_, params); }), BRUME_ERROR_ARGUMENT);
  // The struct of 0.2, which ends before `level`: none are held.
  params.struct_size = offsetof(brume_receiver_params, level);
  Receiver earlier(context_, params);
  EXPECT_EQ(earlier.receive(packets[0]), BRUME_RECEPTION_APPLIED);
  EXPECT_EQ(earlier.receive(packets[2]), BRUME_RECEPTION_MISSED);
}

}  // namespace
}  // namespace brume::api
