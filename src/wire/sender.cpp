#include "wire/sender.hpp"

#include <algorithm>
#include <string>

namespace brume::wire {

Sender::Sender(const SenderSettings& settings) : settings_(settings) {
  BRUME_ASSERT(settings.history >= 1, "a history of no states");
}

Result<std::vector<std::byte>> Sender::push(const sim::State& state) {
  if (state.tick > kMaxPacketTick)
    return Failure{ErrorCode::bad_input,
                   "sender: expected a tick of at most " + std::to_string(kMaxPacketTick)};
  // Fewer events than before: a new world.
  if (!history_.empty() && state.events < history_.back().events && state.tick > history_.back().tick)
    history_.clear();

  // A keyframe for the first state, a delta for the others.
  std::vector<std::byte> packet;
  if (history_.empty()) {
    packet = keyframe_ = write_keyframe(state);
  } else {
    const sim::State& last = history_.back();
    if (state.tick <= last.tick)
      return Failure{ErrorCode::bad_input, "sender: expected a state after tick " +
                                               std::to_string(last.tick) + ", not of tick " +
                                               std::to_string(state.tick)};
    if (auto reason = sim::foreign_reason(state, last, "the last state"))
      return Failure{ErrorCode::bad_input, "sender: " + *reason};
    packet = write_delta(last, state);
    keyframe_.clear();
  }
  history_.push_back(state);
  if (history_.size() > settings_.history) history_.pop_front();
  return packet;
}

Result<std::vector<std::byte>> Sender::answer(std::span<const std::byte> request) {
  const auto held = read_request(request);  // the receiver's state
  if (!held) return held.failure();
  if (history_.empty()) return Failure{ErrorCode::bad_input, "sender: no state to send yet; push one first"};
  const sim::State& last = history_.back();
  if (held->tick) {
    const auto base = std::lower_bound(history_.begin(), history_.end(), *held->tick,
                                       [](const sim::State& s, std::uint32_t tick) { return s.tick < tick; });
    if (base != history_.end() && base->tick == *held->tick && checksum_of(*base) == held->checksum) {
      if (base->tick == last.tick) return std::vector<std::byte>();
      return write_delta(*base, last);
    }
  }
  if (keyframe_.empty()) keyframe_ = write_keyframe(last);
  return keyframe_;
}

}  // namespace brume::wire
