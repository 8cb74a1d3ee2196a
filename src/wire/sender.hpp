// The side that has the World: a packet a tick for everyone, and answers for those who missed some.
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
  std::uint32_t history = 128;  ///< States kept to answer from, at least 1: two seconds.
};

class Sender {
 public:
  explicit Sender(const SenderSettings& settings = {});

  /// Takes the state of a tick and returns the packet to send to every receiver: what is different since the
  /// state pushed before, or a keyframe for the first one and for one of fewer events than the last (another
  /// world goes on). Fails with bad_input when the tick is not above the last one's or above kMaxPacketTick,
  /// or layout, ticks_per_second or masks are others.
  Result<std::vector<std::byte>> push(const sim::State& state);

  /// What to send to the one receiver that asked: a delta from the state that it has, a keyframe where that
  /// is too old or not the same, nothing (empty) when it is up to date. Fails with bad_input for what is no
  /// request, and when nothing was pushed yet.
  Result<std::vector<std::byte>> answer(std::span<const std::byte> request);

 private:
  SenderSettings settings_;
  std::deque<sim::State> history_;   // by tick
  std::vector<std::byte> keyframe_;  // of the last; empty: not asked for yet
};

}  // namespace brume::wire
