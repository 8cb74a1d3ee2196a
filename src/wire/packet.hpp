// The bytes of packets (docs/wire-format.md): a whole State, or what became different since an earlier one.
//
//   keyframe   kind | tick | checksum | body              body: range coded
//   delta      kind | tick | ticks since its base | checksum | body
//   request    kind | 0, or 1 + the tick of the state that is there, and its checksum
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "sim/state.hpp"
#include "wire/limits.hpp"

namespace brume::wire {

constexpr std::uint8_t kVersion = 2;

/// Later ticks do not displacements: a year at 64 a second.
constexpr std::uint32_t kMaxPacketTick = (1u << 31) - 1;

/// The lower half of the first byte; the version is the upper half.
enum class PacketKind : std::uint8_t { keyframe = 1, delta = 2, request = 3, events = 4 };

/// What a packet says before its body.
struct PacketHead {
  PacketKind kind = PacketKind::request;
  std::uint32_t tick = 0;       ///< Of the state that it makes.
  std::uint32_t base_tick = 0;  ///< Of the state that a delta begins with.
  std::uint32_t checksum = 0;   ///< checksum_of the state that it makes.
  std::span<const std::byte> body;
};

/// What a receiver tells of itself: the state that it has, if any.
struct Request {
  std::optional<std::uint32_t> tick;
  std::uint32_t checksum = 0;
  bool operator==(const Request&) const = default;
};

/// The lower half of State::hash().
std::uint32_t checksum_of(const sim::State& state);

/// state.tick <= kMaxPacketTick.
std::vector<std::byte> write_keyframe(const sim::State& state);
/// base.tick < now.tick <= kMaxPacketTick, base.events <= now.events; both of the same layout,
/// ticks_per_second and masks.
std::vector<std::byte> write_delta(const sim::State& base, const sim::State& now);
std::vector<std::byte> write_request(const Request& request);

/// Of keyframes and deltas. Fails with bad_input for what is neither, of another version, or too long.
Result<PacketHead> read_head(std::span<const std::byte> packet, const Limits& limits = {});
Result<Request> read_request(std::span<const std::byte> packet);

/// The state that a packet makes. Fails with bad_input when the bytes are cut short, too many, out of range,
/// contradict each other, are beyond the limits, or make a state of another checksum. Never allocates more
/// than the limits and the bytes that are there allow.
Result<sim::State> read_keyframe(const PacketHead& head, const Limits& limits = {});
Result<sim::State> read_delta(const PacketHead& head, const sim::State& base, const Limits& limits = {});

}  // namespace brume::wire
