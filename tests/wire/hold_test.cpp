// Early packets that a receiver holds.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <random>
#include <utility>
#include <vector>

#include "tests/wire/busy_world.hpp"
#include "wire/receiver.hpp"
#include "wire/sender.hpp"

namespace brume::wire {
namespace {

using Bytes = std::vector<std::byte>;

/// The packets of a match, by tick.
struct Recorded {
  std::vector<Bytes> packets;
  std::vector<sim::State> states;
};

Recorded record(std::uint32_t ticks) {
  const voxel::BitGrid level = yard({40, 16, 40});
  sim::World world = world_of(level, busy_match(level, 6, ticks, 300));
  Sender sender;
  Recorded match;
  for (std::uint32_t tick = 0; tick < ticks; ++tick) {
    world.advance_to(tick);
    match.packets.push_back(*sender.push(world.state()));
    match.states.push_back(world.state());
  }
  return match;
}

/// How often each result came, and how often the receiver was behind.
struct Receptions {
  std::array<std::uint32_t, 5> of{};
  std::uint32_t behind = 0;
  std::uint32_t operator[](Reception reception) const { return of[static_cast<std::size_t>(reception)]; }
};

/// Gives the packets of a match to a receiver, after the first one in random order: each up to `jitter` ticks
/// late, some twice.
Receptions receive_late(const Recorded& match, std::uint32_t jitter, Receiver& receiver,
                        std::mt19937& random) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> order;  // arrival, tick
  for (std::uint32_t tick = 1; tick < match.packets.size(); ++tick)
    for (std::uint32_t copies = random() % 8 == 0 ? 2 : 1; copies > 0; --copies)
      order.emplace_back(tick + static_cast<std::uint32_t>(random() % (jitter + 1)), tick);
  std::shuffle(order.begin(), order.end(), random);
  std::ranges::stable_sort(order, {}, [](const auto& one) { return one.first; });
  EXPECT_EQ(*receiver.receive(match.packets[0]), Reception::applied);
  Receptions receptions;
  for (const auto& [arrival, tick] : order) {
    const std::uint32_t before = receiver.state()->tick;
    const Reception reception = *receiver.receive(match.packets[tick]);
    ++receptions.of[static_cast<std::size_t>(reception)];
    receptions.behind += receiver.behind();
    EXPECT_EQ(receiver.state()->hash(), match.states[receiver.state()->tick].hash());
    EXPECT_EQ(receiver.state()->tick > before, reception == Reception::applied) << "by rising ticks";
  }
  return receptions;
}

// Without loss no packet is thrown away, and no state counts as lost; each packet is used once.
TEST(Receiver, HoldsEveryEarlyPacket) {
  constexpr std::uint32_t kTicks = 300;
  const Recorded match = record(kTicks);
  std::mt19937 random(5);
  for (std::uint32_t jitter = 0; jitter <= 12; ++jitter) {
    Receiver receiver(ReceiverSettings{.hold_ticks = jitter});
    const Receptions receptions = receive_late(match, jitter, receiver, random);
    EXPECT_EQ(receptions[Reception::missed], 0u) << jitter;
    EXPECT_EQ(receptions.behind, 0u) << jitter;
    EXPECT_EQ(receptions[Reception::applied] + receptions[Reception::held], kTicks - 1) << jitter;
    EXPECT_EQ(receptions[Reception::held] > 0, jitter > 0) << jitter;
    expect_same(*receiver.state(), match.states.back());
  }
  Receiver none;
  EXPECT_GT(receive_late(match, 1, none, random)[Reception::missed], 0u) << "what holding is for";
}

/// Packets used and requests sent in a match over a network with jitter, without loss; requests are answered
/// at once.
struct Used {
  std::uint32_t packets = 0, requests = 0;
};

Used play_with_jitter(const Recorded& match, std::uint32_t jitter, std::uint32_t hold_ticks) {
  std::mt19937 random(9);
  Sender sender;
  Receiver receiver(ReceiverSettings{.hold_ticks = hold_ticks});
  std::vector<std::vector<std::uint32_t>> arriving(match.packets.size() + jitter);
  Used used;
  for (std::uint32_t tick = 0; tick < match.packets.size(); ++tick) {
    EXPECT_TRUE(sender.push(match.states[tick]));
    arriving[tick + (tick == 0 ? 0 : random() % (jitter + 1))].push_back(tick);
    std::ranges::shuffle(arriving[tick], random);
    for (const std::uint32_t packet : arriving[tick]) {
      const Reception reception = *receiver.receive(match.packets[packet]);
      used.packets += reception == Reception::applied || reception == Reception::held;
    }
    if (!receiver.behind()) continue;
    ++used.requests;
    EXPECT_TRUE(receiver.receive(*sender.answer(receiver.request())));
    EXPECT_EQ(receiver.state()->tick, tick) << "answered at once";
  }
  return used;
}

// The figures of docs/reference/c-api.md.
TEST(Receiver, UsesMorePacketsAndSendsFewerRequestsWhenItHolds) {
  const Recorded match = record(1000);
  for (const std::uint32_t jitter : {1u, 2u, 4u, 9u}) {
    const Used without = play_with_jitter(match, jitter, 0), with = play_with_jitter(match, jitter, jitter);
    std::printf("| %u | %u; %u | %u; %u |\n", jitter, without.packets, without.requests, with.packets,
                with.requests);
    EXPECT_LT(without.packets, 900u);
    EXPECT_GT(without.requests, 100u);
    EXPECT_GE(with.packets, 1000 - jitter) << "the last ones are still under way";
    EXPECT_EQ(with.requests, 0u);
  }
}

TEST(Receiver, NoticesALossWhenPacketsAreLaterThanItHolds) {
  const Recorded match = record(40);
  for (const std::uint32_t hold : {0u, 1u, 3u, 8u}) {
    Receiver receiver(ReceiverSettings{.hold_ticks = hold});
    EXPECT_EQ(*receiver.receive(match.packets[0]), Reception::applied);
    for (std::uint32_t tick = 2; tick <= hold + 1; ++tick) {  // The packet of tick 1 is lost.
      EXPECT_EQ(*receiver.receive(match.packets[tick]), Reception::held);
      EXPECT_EQ(*receiver.receive(match.packets[tick]), hold == 0 ? Reception::missed : Reception::old);
      EXPECT_FALSE(receiver.behind());
    }
    EXPECT_EQ(*receiver.receive(match.packets[hold + 2]), Reception::missed);
    EXPECT_TRUE(receiver.behind());

    // The answer, and at once what was received after it.
    for (std::uint32_t tick = hold + 3; tick < 20; ++tick)
      EXPECT_EQ(*receiver.receive(match.packets[tick]), Reception::missed);
    const std::uint32_t answered = 19 - hold;
    EXPECT_EQ(*receiver.receive(write_delta(match.states[0], match.states[answered])), Reception::applied);
    EXPECT_EQ(receiver.state()->tick, 19u);
    EXPECT_FALSE(receiver.behind());
    expect_same(*receiver.state(), match.states[19]);
  }
}

TEST(Receiver, HoldsNoMoreThanItsLimits) {
  const Recorded match = record(40);
  // By number: with an answer one tick earlier, the first packet after it is gone.
  Receiver receiver(ReceiverSettings{.hold_ticks = 3});
  ASSERT_TRUE(receiver.receive(match.packets[0]));
  for (std::uint32_t tick = 2; tick < 20; ++tick) ASSERT_TRUE(receiver.receive(match.packets[tick]));
  EXPECT_EQ(*receiver.receive(write_delta(match.states[0], match.states[15])), Reception::applied);
  EXPECT_EQ(receiver.state()->tick, 15u);
  EXPECT_EQ(*receiver.receive(match.packets[16]), Reception::applied);
  EXPECT_EQ(receiver.state()->tick, 19u);

  // By bytes: all held packets together.
  std::uint64_t bytes = 0, largest = match.packets[0].size();
  for (std::uint32_t tick = 2; tick < 40; ++tick) {
    bytes += match.packets[tick].size();
    largest = std::max<std::uint64_t>(largest, match.packets[tick].size());
  }
  ASSERT_LT(largest, bytes) << "each packet alone is within the limit";
  for (const std::uint64_t room : {bytes, bytes - 1}) {
    Receiver small(ReceiverSettings{.limits = {.max_bytes = room}, .hold_ticks = 38});
    ASSERT_TRUE(small.receive(match.packets[0]));
    for (std::uint32_t tick = 2; tick < 40; ++tick) ASSERT_TRUE(small.receive(match.packets[tick])) << tick;
    ASSERT_TRUE(small.receive(match.packets[1]));
    EXPECT_EQ(small.state()->tick, room == bytes ? 39u : 1u);
  }
}

// What is damaged can show when its turn comes: the packets before it are used, and it is requested.
TEST(Receiver, DropsADamagedHeldPacket) {
  const Recorded match = record(10);
  Receiver receiver(ReceiverSettings{.hold_ticks = 4});
  ASSERT_TRUE(receiver.receive(match.packets[0]));
  Bytes damaged = match.packets[2];
  damaged.back() ^= std::byte{0x55};
  EXPECT_EQ(*receiver.receive(damaged), Reception::held);
  EXPECT_EQ(*receiver.receive(match.packets[3]), Reception::held);
  EXPECT_EQ(*receiver.receive(match.packets[1]), Reception::applied);
  EXPECT_EQ(receiver.state()->tick, 1u);
  EXPECT_TRUE(receiver.behind());
  EXPECT_EQ(*receiver.receive(match.packets[2]), Reception::applied);
  EXPECT_EQ(receiver.state()->tick, 3u);
  EXPECT_FALSE(receiver.behind());
}

}  // namespace
}  // namespace brume::wire
