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
  applied,  ///< state() is now the packet's, or of a held packet that builds on it.
  old,      ///< Ignored: state() is of that tick or a later one, or a packet of that tick is held.
  missed,   ///< The state it is relative to is missing. Send a request.
  held,     ///< Early: applied as soon as the packets before it arrive.
  foreign   ///< Ignored: a keyframe of another level than ReceiverSettings::level_hash.
};

/// The largest ReceiverSettings::hold_ticks.
constexpr std::uint32_t kMaxHoldTicks = 64;

struct ReceiverSettings {
  Limits limits = {};
  std::optional<std::uint64_t> level_hash = {};  ///< The level of all states; none: any.
  /// By how many ticks packets may overtake others, [0, kMaxHoldTicks]. Deltas from states up to so many
  /// ticks after state() are held until these states are there; at most so many packets, of at most
  /// Limits::max_bytes together. A state that is missing for longer counts as lost.
  std::uint32_t hold_ticks = 0;
};

class Receiver {
 public:
  explicit Receiver(const ReceiverSettings& settings = {});

  /// Processes a packet, and held ones that build on it, in the order of their ticks. Fails with bad_input,
  /// in one line, and changes nothing but behind() when the packet is damaged or gives another state than the
  /// sender's; send a request then, too. A held packet that turns out to be damaged is dropped, and behind()
  /// is then true.
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
  struct Early {
    std::uint32_t tick = 0, base_tick = 0;
    std::vector<std::byte> packet;
  };

  const sim::State* find(std::uint32_t tick) const;
  Result<Reception> apply(const PacketHead& head);
  Reception hold(std::span<const std::byte> packet, const PacketHead& head);
  void apply_held();
  bool is_lost(std::uint32_t base_tick) const;

  ReceiverSettings settings_;
  std::deque<sim::State> states_;  // sorted by tick; older ones are the bases of late deltas
  std::vector<Early> held_;        // sorted by tick, one for each
  bool behind_ = false;
};

}  // namespace brume::wire
