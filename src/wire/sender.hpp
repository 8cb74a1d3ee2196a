// The sending side, which has the World: one packet per tick for all receivers, and replies to those that
// missed some.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "sim/state.hpp"
#include "wire/packet.hpp"

namespace brume::wire {

struct SenderSettings {
  std::uint32_t history = 128;  ///< States retained for replies, at least 1. 128 ticks: two seconds.
};

class Sender {
 public:
  explicit Sender(const SenderSettings& settings = {});

  /// Takes the state of a tick and returns the packet to send to every receiver: a delta from the previous
  /// state, or a keyframe for the first one and for one with fewer events than the last (a new world). Fails
  /// with bad_input when the tick is not above the last one's or above kMaxPacketTick, or level,
  /// ticks_per_second or masks have changed.
  Result<std::vector<std::byte>> push(const sim::State& state);

  /// The reply to one receiver's request: a delta from the state it has, a keyframe when that state is too
  /// old or differs, or nothing (empty) when it is up to date. Fails with bad_input for bytes that are not a
  /// request, and before the first push.
  Result<std::vector<std::byte>> answer(std::span<const std::byte> request);

 private:
  SenderSettings settings_;
  std::deque<sim::State> history_;   // sorted by tick
  std::vector<std::byte> keyframe_;  // the last state's; empty: not created yet
};

}  // namespace brume::wire
