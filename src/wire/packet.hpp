// Packets (docs/reference/formats.md): a complete State, or its differences from an earlier one.
//
//   keyframe   kind | tick | checksum | body              body: range coded
//   delta      kind | tick | ticks since its base | checksum | body
//   request    kind | 0, or 1 + the tick of the receiver's state, and its checksum
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

/// Version of packets, event logs and replays, and of the rules that states follow: programs of other
/// versions would not agree.
constexpr std::uint8_t kVersion = 4;

/// Largest tick that can be sent: about a year at 64 ticks per second.
constexpr std::uint32_t kMaxPacketTick = (1u << 31) - 1;

/// The lower half of the first byte; the version is the upper half.
enum class PacketKind : std::uint8_t { keyframe = 1, delta = 2, request = 3, events = 4 };

/// The header of a packet.
struct PacketHead {
  PacketKind kind = PacketKind::request;
  std::uint32_t tick = 0;       ///< Tick of the packet's state.
  std::uint32_t base_tick = 0;  ///< Tick of the state that a delta is relative to.
  std::uint32_t checksum = 0;   ///< checksum_of the packet's state.
  std::span<const std::byte> body;
};

/// A receiver's request: the state it has, if any.
struct Request {
  std::optional<std::uint32_t> tick;
  std::uint32_t checksum = 0;
  bool operator==(const Request&) const = default;
};

/// The lower half of State::hash().
std::uint32_t checksum_of(const sim::State& state);

/// state.tick <= kMaxPacketTick.
std::vector<std::byte> write_keyframe(const sim::State& state);
/// base.tick < now.tick <= kMaxPacketTick, base.events <= now.events; both of the same level,
/// ticks_per_second and masks.
std::vector<std::byte> write_delta(const sim::State& base, const sim::State& now);
std::vector<std::byte> write_request(const Request& request);

/// The header of a keyframe or delta. Fails with bad_input for any other packet, another version, or too many
/// bytes.
Result<PacketHead> read_head(std::span<const std::byte> packet, const Limits& limits = {});
Result<Request> read_request(std::span<const std::byte> packet);

/// The state of a packet. Fails with bad_input when the bytes are truncated, too many, out of range,
/// inconsistent or beyond the limits, or when the checksum differs. Never allocates more than the limits and
/// the bytes given allow.
Result<sim::State> read_keyframe(const PacketHead& head, const Limits& limits = {});
Result<sim::State> read_delta(const PacketHead& head, const sim::State& base, const Limits& limits = {});

}  // namespace brume::wire
