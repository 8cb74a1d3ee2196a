// The receiving side, without level or World: turns packets, in any order and with gaps, into the sender's
// states.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "sim/state.hpp"
#include "wire/limits.hpp"
#include "wire/packet.hpp"

namespace brume::wire {

/// The result of receiving a packet.
enum class Reception {
  applied,  ///< state() is now the packet's.
  old,      ///< Ignored: state() is of that tick or a later one.
  missed,   ///< Ignored: the state it is relative to is missing. Send a request.
  foreign   ///< Ignored: a keyframe of another level than ReceiverSettings::level_hash.
};

struct ReceiverSettings {
  Limits limits = {};
  std::optional<std::uint64_t> level_hash = {};  ///< The level of all states; none: any.
};

class Receiver {
 public:
  explicit Receiver(const ReceiverSettings& settings = {}) : settings_(settings) {}

  /// Processes a packet. Fails with bad_input, in one line, and changes nothing but behind() when it is
  /// damaged or gives another state than the sender's; send a request then, too.
  Result<Reception> receive(std::span<const std::byte> packet);

  /// The newest state, equal bit for bit to the sender's of that tick; null: none received yet. Valid until
  /// the next packet.
  const sim::State* state() const { return states_.empty() ? nullptr : &states_.back(); }

  /// True when a state is known to be missing: send request() to the sender every few ticks until it is
  /// false. Send one also when no packet has arrived for a while: the last one may be lost.
  bool behind() const { return states_.empty() || behind_; }
  std::vector<std::byte> request() const;

  /// Drops all states: a new match starts, perhaps at an earlier tick.
  void reset();

 private:
  const sim::State* find(std::uint32_t tick) const;

  ReceiverSettings settings_;
  std::deque<sim::State> states_;  // sorted by tick; older ones are the bases of late deltas
  bool behind_ = false;
};

}  // namespace brume::wire
