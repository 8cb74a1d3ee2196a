#include "wire/packet.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <functional>

#include "tests/sanitized.hpp"
#include "tests/sim/random_events.hpp"
#include "tests/wire/busy_world.hpp"
#include "wire/state_coding.hpp"

namespace brume::wire {
namespace {

using Bytes = std::vector<std::byte>;

Result<sim::State> read(std::span<const std::byte> packet, const sim::State* base,
                        const Limits& limits = {}) {
  const auto head = read_head(packet, limits);
  if (!head) return head.failure();
  if (head->kind == PacketKind::keyframe) return read_keyframe(*head, limits);
  if (!base || base->tick != head->base_tick) return Failure{ErrorCode::bad_input, "no base"};
  return read_delta(*head, *base, limits);
}

TEST(Packet, RoundTripsKeyframesOfABusyMatch) {
  const voxel::BitGrid level = rooms(1);
  sim::World world = world_of(level, busy_match(level, 1, 600, 500));
  for (std::uint32_t tick = 0; tick <= 700; tick += 7) {
    world.advance_to(tick);
    const auto back = read(write_keyframe(world.state()), nullptr).value_or_throw();
    expect_same(back, world.state());
  }
}

// From any earlier state, not only the last one.
TEST(Packet, RoundTripsDeltasOfABusyMatch) {
  const voxel::BitGrid level = rooms(2);
  sim::World world = world_of(level, busy_match(level, 2, 600, 500));
  std::mt19937 random(1);
  std::vector<sim::State> got{*read(write_keyframe(world.state()), nullptr)};
  for (std::uint32_t tick = 1; tick <= 700; ++tick) {
    world.advance_to(tick);
    const std::size_t back = std::min<std::size_t>(got.size(), 1 + (random() % 4 == 0 ? random() % 100 : 0));
    const sim::State& base = got[got.size() - back];
    auto next = read(write_delta(base, world.state()), &base);
    ASSERT_TRUE(next) << "tick " << tick << ": " << next.failure().message;
    ASSERT_EQ(next->hash(), world.state_hash()) << tick;
    got.push_back(std::move(*next));
  }
  expect_same(got.back(), world.state());
}

TEST(Packet, RoundTripsWhatEventsOfEveryKindLeave) {
  const voxel::BitGrid level = yard({40, 16, 40});
  sim::World world = world_of(level, sim::random_events(1, level.layout(), 30, 400));
  sim::State last = world.state();
  for (std::uint32_t tick = 3; tick <= 800; tick += 3) {
    world.advance_to(tick);
    const sim::State keyframe = read(write_keyframe(world.state()), nullptr).value_or_throw();
    ASSERT_EQ(keyframe.hash(), world.state_hash()) << tick;
    last = read(write_delta(last, world.state()), &last).value_or_throw();
    ASSERT_EQ(last.hash(), world.state_hash()) << tick;
  }
}

// Unchanged clouds are not copied.
TEST(Packet, SharesUnchangedClouds) {
  const voxel::BitGrid level = yard({24, 12, 24});
  sim::World world = one_smoke(level);
  world.advance_to(100);
  const auto before = read(write_keyframe(world.state()), nullptr);
  ASSERT_TRUE(before && before->clouds.size() == 1);
  world.advance_to(110);
  const auto after = read(write_delta(*before, world.state()), &*before);
  ASSERT_TRUE(after);
  EXPECT_EQ(after->clouds[0].cloud, before->clouds[0].cloud);
}

// SPEC K10: a grown smoke in at most 1 KiB; growing, at most 64 bytes per tick.
TEST(Packet, AGrownSmokeIsSmall) {
  const auto measure = [](const char* name, const voxel::BitGrid& level, glm::ivec3 from, glm::ivec3 at) {
    sim::World world =
        world_of(level, {sim::ThrowSmoke{5, centre_of(level, from), centre_of(level, at), {}}});
    sim::State last = world.state();
    std::size_t bytes = 0, ticks = 0, largest = 0;
    while (world.state().clouds.empty() ||
           world.tick() < world.state().clouds[0].cloud->origin().detonation_tick + 64) {
      ASSERT_LT(world.tick(), 1000u);
      world.step();
      const std::size_t size = write_delta(last, world.state()).size();
      last = world.state();
      if (last.clouds.empty()) continue;
      bytes += size;
      ++ticks;
      largest = std::max(largest, size);
    }
    ASSERT_EQ(last.clouds[0].cloud->voxels().size(), 1800u) << name;
    const std::size_t keyframe = write_keyframe(last).size();
    const double mean = static_cast<double>(bytes) / static_cast<double>(ticks);
    std::printf("%-12s keyframe %zu bytes, deltas while growing: mean %.1f, largest %zu\n", name, keyframe,
                mean, largest);
    EXPECT_LE(keyframe, 1024u) << name;
    EXPECT_LE(mean, 64) << name;
  };
  measure("yard", yard(), {48, 4, 20}, {48, 1, 48});
  measure("air", voxel::BitGrid({{96, 96, 96}, 0.5f, glm::vec3(-24)}), {48, 40, 20}, {47, 46, 49});
  measure("corridor", corridors(), {32, 2, 200}, {32, 2, 240});
  for (unsigned seed = 0; seed < 4; ++seed) {
    const voxel::BitGrid level = rooms(seed);
    std::mt19937 random(seed);
    const glm::ivec3 voxel = free_voxel(level, random);
    measure("rooms", level, voxel, voxel);
  }
}

// A door opens under a smoke: its moving densities take less than one byte a voxel.
TEST(Packet, ASmokeThatFlowsThroughADoorIsSmall) {
  const voxel::BitGrid level = rooms(3);
  std::mt19937 random(3);
  const glm::ivec3 voxel = free_voxel(level, random);
  const glm::ivec3 low = voxel - glm::ivec3(6, 2, 6);
  sim::World world =
      world_of(level, {sim::ThrowSmoke{0, centre_of(level, voxel), centre_of(level, voxel), {}},
                       sim::LevelEdit{200, sim::edit_box(level.layout(), low, low + 12, false)}});
  world.advance_to(199);
  const sim::State before = world.state();
  world.advance_to(200);
  ASSERT_EQ(world.state().clouds.size(), 1u);
  ASSERT_NE(world.state().clouds[0].cloud->parts().flow_tick, 0u);
  const Bytes delta = write_delta(before, world.state());
  std::printf("a door opens: %zu bytes\n", delta.size());
  EXPECT_LT(delta.size(), 1800u * 2);
  const auto back = read(delta, &before).value_or_throw();
  expect_same(back, world.state());
}

// A packet that is truncated, longer or has any flipped bit is rejected or decodes to the same state.
TEST(Packet, RejectsDamage) {
  constexpr std::size_t kBitStep = kSanitized ? 61 : 5;  // odd: meets bits of every value
  const voxel::BitGrid level = yard({20, 9, 17});
  sim::World world = world_of(level, busy_match(level, 5, 100, 40));
  world.advance_to(60);
  const sim::State base = world.state();
  world.advance_to(64);
  const std::uint64_t hash = world.state_hash();
  for (const Bytes& packet : {write_keyframe(world.state()), write_delta(base, world.state())}) {
    ASSERT_TRUE(read(packet, &base));
    for (std::size_t length = 0; length < packet.size(); length += kSanitized ? 7 : 1)
      EXPECT_FALSE(read(std::span<const std::byte>(packet).first(length), &base)) << length;
    Bytes longer = packet;
    longer.insert(longer.end(), 5, std::byte{1});
    EXPECT_FALSE(read(longer, &base));
    for (std::size_t bit = 0; bit < packet.size() * 8; bit += kBitStep) {
      Bytes damaged = packet;
      damaged[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
      const auto got = read(damaged, &base);
      if (got) {
        EXPECT_EQ(got->hash(), hash) << bit;
      }
    }
  }
}

TEST(Packet, EnforcesLimits) {
  const voxel::BitGrid level = yard({24, 12, 24});
  sim::World world = one_smoke(level, {sim::MoveBody{1, 1, {}}, sim::MoveBody{1, 2, {}}});
  world.advance_to(100);
  const Bytes packet = write_keyframe(world.state());
  EXPECT_TRUE(read(packet, nullptr));
  EXPECT_FALSE(read(packet, nullptr, {.max_bytes = packet.size() - 1}));
  EXPECT_FALSE(read(packet, nullptr, {.max_voxels = 299}));
  EXPECT_FALSE(read(packet, nullptr, {.max_items = 1}));
}

// Rejects states that no simulation produces, even with a matching checksum.
TEST(Packet, RejectsContradictions) {
  const voxel::BitGrid level = yard({24, 12, 24});
  sim::World world = world_of(level, busy_match(level, 9, 100, 60));
  world.advance_to(60);
  sim::State valid = world.state();
  valid.blasts.clear();  // they could not even be written into an impossible grid
  ASSERT_TRUE(read(write_keyframe(valid), nullptr));
  ASSERT_FALSE(valid.clouds.empty());
  ASSERT_FALSE(valid.holes.empty());
  ASSERT_FALSE(valid.bodies.empty());
  const auto refused = [&](const std::function<void(sim::State&)>& change) {
    sim::State state = valid;
    change(state);
    const auto got = read(write_keyframe(state), nullptr);
    return !got && got.failure().code == ErrorCode::bad_input;
  };
  EXPECT_TRUE(refused([](auto& s) { s.events = 0; }));
  EXPECT_TRUE(refused([](auto& s) { s.tick = 1; }));
  EXPECT_TRUE(refused([](auto& s) { s.ticks_per_second = 0; }));
  EXPECT_TRUE(refused([](auto& s) { s.ticks_per_second = 1001; }));
  EXPECT_TRUE(refused([](auto& s) { s.layout.voxel_size = 0; }));
  EXPECT_TRUE(refused([](auto& s) { s.layout.voxel_size = std::numeric_limits<float>::quiet_NaN(); }));
  EXPECT_TRUE(refused([](auto& s) { s.layout.origin_world.y = std::numeric_limits<float>::infinity(); }));
  EXPECT_TRUE(refused([](auto& s) { s.layout.size = glm::ivec3(4); }));
  EXPECT_TRUE(refused([](auto& s) { s.holes[0].distance = 0; }));
  EXPECT_TRUE(refused([](auto& s) { s.holes[0].shot.toward = s.holes[0].shot.origin; }));
  EXPECT_TRUE(refused([](auto& s) { s.holes[0].shot.radius = 0; }));
  EXPECT_TRUE(refused([](auto& s) { s.holes.push_back(s.holes[0]); }));
  EXPECT_TRUE(refused([](auto& s) { s.masks.count = sim::kMaxMasks + 1; }));
  EXPECT_TRUE(refused([](auto& s) {
    s.holes[0].shot.shape = sim::HoleShape::mask;
    s.holes[0].shot.mask = s.masks.count;
  }));
  EXPECT_TRUE(refused([](auto& s) { s.bodies[0].position.x = 1 << 25; }));
  EXPECT_TRUE(refused([](auto& s) { s.bodies[0].previous_tick = s.bodies[0].tick + 1; }));
  EXPECT_TRUE(refused([](auto& s) { s.flights.push_back({0, {}, {}, 60, 60, {}}); }));
  EXPECT_TRUE(refused([](auto& s) { s.flights.push_back({0, {}, {99, 0, 0}, 50, 60, {}}); }));
  EXPECT_TRUE(refused([](auto& s) {
    s.edits = std::make_shared<const sim::EditBlocks>(sim::EditBlocks{{glm::i16vec3(0), 1, 1}});
  }));
}

// A delta that removes events would leave objects without an event.
TEST(Packet, RejectsDeltasThatRemoveEvents) {
  const voxel::BitGrid level = yard({24, 12, 24});
  sim::World world = world_of(level, busy_match(level, 9, 100, 60));
  world.advance_to(60);
  sim::State later = world.state();
  ++later.tick;
  EXPECT_TRUE(read_body(write_body(world.state(), later), world.state(), later.tick, {}));
  later.events = 0;
  EXPECT_FALSE(read_body(write_body(world.state(), later), world.state(), later.tick, {}));
}

TEST(Packet, RoundTripsRequests) {
  for (const Request& request : {Request{}, Request{0, 7}, Request{~std::uint32_t{0}, ~std::uint32_t{0}}}) {
    const Bytes bytes = write_request(request);
    EXPECT_LE(bytes.size(), 10u);
    const auto back = read_request(bytes);
    ASSERT_TRUE(back);
    EXPECT_EQ(*back, request);
    for (std::size_t length = 0; length < bytes.size(); ++length)
      EXPECT_FALSE(read_request(std::span<const std::byte>(bytes).first(length)));
    Bytes longer = bytes;
    longer.push_back(std::byte{0});
    EXPECT_FALSE(read_request(longer));
    EXPECT_FALSE(read_head(bytes));
  }
}

}  // namespace
}  // namespace brume::wire
