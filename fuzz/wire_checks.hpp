// The guarantees of the wire readers for arbitrary bytes: used by the fuzzers and by the test that replays
// their corpus.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/error.hpp"
#include "core/hash.hpp"
#include "sim/event_fields.hpp"
#include "sim/world.hpp"
#include "smoke/holes.hpp"
#include "wire/bytes.hpp"
#include "wire/event_log.hpp"
#include "wire/receiver.hpp"
#include "wire/replay.hpp"
#include "wire/state_coding.hpp"
#include "wire/world_archive.hpp"

namespace brume::wire {

using Input = std::span<const std::byte>;

// Small, to keep runs short.
constexpr Limits kFuzzLimits{.max_bytes = 4096, .max_voxels = 512, .max_items = 12};

/// A small level: ground, a wall with a door, a pillar.
inline const voxel::BitGrid& fuzz_level() {
  static const voxel::BitGrid level = [] {
    voxel::BitGrid grid({{13, 7, 10}, 0.5f, glm::vec3(-2, -0.5f, -2)});
    for (const auto& [low, high, solid] : {std::tuple(glm::ivec3(0), glm::ivec3(13, 1, 10), true),
                                           std::tuple(glm::ivec3(6, 0, 0), glm::ivec3(7, 7, 10), true),
                                           std::tuple(glm::ivec3(6, 1, 4), glm::ivec3(7, 4, 6), false),
                                           std::tuple(glm::ivec3(2, 1, 2), glm::ivec3(3, 5, 3), true)})
      sim::apply_edits(grid, sim::edit_box(grid.layout(), low, high, solid));
    return grid;
  }();
  return level;
}

/// The state of a packet relative to another one, ignoring its checksum.
inline Result<sim::State> state_of(const PacketHead& head, const sim::State& base) {
  if (head.kind == PacketKind::delta) return read_body(head.body, base, head.tick, kFuzzLimits);
  ByteReader in(head.body);
  const auto world = read_world(in);
  if (!world) return world.failure();
  return read_body(in.remaining(), first_state(*world), head.tick, kFuzzLimits);
}

/// Any decoded state must survive all queries and must be sendable.
inline void check_state(const sim::State& base, const sim::State& state) {
  for (const sim::LiveCloud& live : state.clouds) {
    const glm::ivec3 low = live.cloud->low(), high = live.cloud->high();
    for (const glm::ivec3 voxel : {low, high, (low + high) / 2}) static_cast<void>(state.density(voxel));
  }
  BRUME_ASSERT(sim::grenades_of(state).size() == state.flights.size(), "grenades");
  // Masks are not sent: holes can only be queried without them.
  if (state.masks == sim::MaskKey{})
    BRUME_ASSERT(smoke::make_holes(state).size() == state.holes.size(), "holes");

  Receiver receiver;
  const auto received = receiver.receive(write_keyframe(state));
  BRUME_ASSERT(received, received.failure().message);
  BRUME_ASSERT(receiver.state()->hash() == state.hash(), "a keyframe gives another state");
  if (base.tick >= state.tick || base.events > state.events || sim::foreign_reason(state, base, "the base"))
    return;
  const std::vector<std::byte> delta = write_delta(base, state);
  const auto head = read_head(delta);
  BRUME_ASSERT(head, head.failure().message);
  const auto again = read_delta(*head, base);
  BRUME_ASSERT(again, again.failure().message);
}

/// A receiver must keep its state and request a new one after any packet that it rejects.
inline void receive_all(const std::vector<Input>& packets, std::uint32_t hold_ticks) {
  Receiver receiver({.limits = kFuzzLimits, .level_hash = {}, .hold_ticks = hold_ticks});
  for (const Input packet : packets) {
    static_cast<void>(read_request(packet));
    const bool had = receiver.state() != nullptr;
    const std::uint64_t before = had ? receiver.state()->hash() : 0;
    const auto received = receiver.receive(packet);
    if (had && (!received || *received != Reception::applied))
      BRUME_ASSERT(receiver.state()->hash() == before, "a rejected packet changed the state");
    BRUME_ASSERT(received || receiver.behind(), "damage without a request");
  }
}

/// Decodes the packets as if their checksums were right.
inline void decode_all(const std::vector<Input>& packets) {
  sim::State base, state;
  base.layout = state.layout = fuzz_level().layout();
  for (const Input packet : packets) {
    const auto head = read_head(packet, kFuzzLimits);
    if (!head || (head->kind == PacketKind::delta && head->tick <= state.tick)) continue;
    auto next = state_of(*head, state);
    if (!next) continue;
    base = std::move(state);
    state = std::move(*next);
  }
  check_state(base, state);
}

/// The first byte selects one of the two, and how many ticks a receiver holds; then follow packets, each
/// after its length.
inline void check_packets(Input bytes) {
  ByteReader in(bytes);
  const auto choice = in.number<std::uint8_t>();
  const bool as_they_are = choice % 4 == 0;
  std::vector<Input> packets;
  while (in.ok() && !in.remaining().empty() && packets.size() < 4) {
    const Input remaining = in.remaining();
    packets.push_back(in.section());
    if (!in.ok()) packets.back() = remaining;
  }
  as_they_are ? receive_all(packets, choice / 4u) : decode_all(packets);
}

/// Lowers what makes an event large: radii and amounts. A visitor of sim/event_fields.hpp.
struct Reduction {
  std::uint32_t max_radius;
  void operator()(const sim::NumberField& field, std::uint32_t& number) const {
    if (field.in_voxels) number = std::min(number, max_radius);
    if (field.key == std::string_view("voxels")) number = std::min(number, 64u);
  }
  void operator()(const auto&, const auto&) const {}
};

/// The events with small smokes and blasts, to keep runs short.
inline std::vector<sim::Event> made_small(std::vector<sim::Event> events, float voxel_size) {
  const auto max_radius = static_cast<std::uint32_t>(voxel_size * 3 * sim::kUnitsPerMetre);
  for (sim::Event& event : events)
    std::visit([&](auto& e) { sim::visit_fields(e, Reduction{max_radius}); }, event);
  return events;
}

/// The body of an event log after a matching header.
inline std::vector<std::byte> as_event_log(Input body) {
  ByteWriter whole;
  whole.number(static_cast<std::uint8_t>(kVersion << 4 | static_cast<int>(PacketKind::events)));
  whole.number(static_cast<std::uint32_t>(hash_bytes(body)));
  whole.raw(body);
  return whole.take();
}

/// Checks the body of an event log, with and without a matching header.
inline void check_event_log(Input body) {
  const voxel::BitGrid& level = fuzz_level();
  static_cast<void>(read_events(body, level.layout(), kFuzzLimits));
  const auto read = read_events(as_event_log(body), level.layout(), kFuzzLimits);
  if (!read) return;
  const auto again = read_events(write_events(*read, level.layout()), level.layout());
  BRUME_ASSERT(again && *again == *read, "events change when written and read again");

  // Append the events in order.
  const std::vector<sim::Event> events = made_small(*read, level.layout().voxel_size);
  std::uint32_t end = 0;
  for (const sim::Event& event : events) end = std::max(end, sim::tick_of(event) + 70);
  // With as many masks as a shot can refer to.
  const sim::WorldSettings settings{.masks = {sim::kMaxMasks, 1}};
  sim::World world(level, settings);
  for (const sim::Event& event : events) world.append(event).value_or_throw();
  world.advance_to(end / 2);
  world.advance_to(end);
  const std::uint64_t hash = world.state_hash();
  if (hash_bytes(body) % 4 != 0) return;  // the following checks are slow

  // Roll back and replay.
  check_state(sim::State{}, world.state());
  world.advance_to(end / 3);
  world.advance_to(end);
  BRUME_ASSERT(world.state_hash() == hash, "rolling back gives another state");

  // Append the events one by one in the past: the same end.
  sim::World late(level, settings);
  late.advance_to(end);
  for (const sim::Event& event : events) late.append(event).value_or_throw();
  BRUME_ASSERT(late.state_hash() == hash, "late events give another state");
}

/// A replay with matching checksums: of its events, if they can be located, and at its end, which the bytes
/// lack.
inline std::vector<std::byte> as_replay(Input bytes) {
  ByteWriter whole;
  ByteReader in(bytes);
  constexpr std::size_t kMagicBytes = 8, kLogHead = 5;
  in.raw(kMagicBytes);
  in.varint(kVersion);
  const bool valid = static_cast<bool>(read_world(in));
  in.section();
  const std::size_t before = bytes.size() - in.remaining().size();
  const Input events = in.section();
  if (valid && in.ok() && events.size() >= kLogHead) {
    whole.raw(bytes.first(before));
    whole.section(as_event_log(events.subspan(kLogHead)));
    whole.raw(in.remaining());
  } else {
    whole.raw(bytes);
  }
  whole.number(hash_bytes(whole.bytes()));
  return whole.take();
}

inline void check_replay(Input bytes) {
  static_cast<void>(decode_replay(bytes));
  const std::vector<std::byte> whole = as_replay(bytes);
  const auto read = decode_replay(whole);
  if (!read) return;
  const auto again = decode_replay(encode_replay(*read).value_or_throw());
  BRUME_ASSERT(again && again->events == read->events && again->checksums == read->checksums,
               "a replay changes when written and read again");
  const glm::u64vec3 size(read->level.size());
  if (size.x * size.y * size.z > 4096 || read->events.size() > 16) return;
  Replay small{read->level, read->settings, made_small(read->events, read->level.layout().voxel_size),
               read->checksums};
  if (small.checksums.size() > 32) small.checksums.resize(32);
  static_cast<void>(play(small));
}

}  // namespace brume::wire
