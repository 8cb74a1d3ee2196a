// The side that has no level and no World: packets in, in any order, with gaps; the sender's states out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "sim/state.hpp"
#include "wire/limits.hpp"
#include "wire/packet.hpp"

namespace brume::wire {

/// What became of a packet.
enum class Reception {
  applied,  ///< state() is the packet's.
  old,      ///< Nothing changed: a state of that tick or a later one is there.
  missed    ///< Nothing changed: the state that it begins with is not there. Time to ask.
};

class Receiver {
 public:
  explicit Receiver(const Limits& limits = {}) : limits_(limits) {}

  /// Takes a packet. Fails with bad_input, one line, and changes nothing when it is damaged or makes another
  /// state than the sender's; time to ask then, too.
  Result<Reception> receive(std::span<const std::byte> packet);

  /// The newest state, equal to the sender's of that tick, bit by bit; null: nothing came yet. Valid until
  /// the next packet.
  const sim::State* state() const { return states_.empty() ? nullptr : &states_.back(); }

  /// True when something is known to be missing: send request() to the sender, again and again (every few
  /// ticks) until it is false. Where nothing came for a while, ask as well: the last packet may be lost.
  bool behind() const { return states_.empty() || behind_; }
  std::vector<std::byte> request() const;

  /// Forgets all: another match begins, at an earlier tick perhaps.
  void reset();

 private:
  const sim::State* find(std::uint32_t tick) const;

  Limits limits_;
  std::deque<sim::State> states_;  // by tick; the earlier ones are there for packets that begin with them
  bool behind_ = false;
};

}  // namespace brume::wire
