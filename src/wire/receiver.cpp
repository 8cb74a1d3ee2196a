#include "wire/receiver.hpp"

#include <algorithm>

namespace brume::wire {
namespace {

// A reply is relative to the state named in the request; this many packets may overtake it.
constexpr std::size_t kStates = 32;

}  // namespace

Result<Reception> Receiver::receive(std::span<const std::byte> packet) {
  // Find the state that a delta is relative to.
  const auto head = read_head(packet, settings_.limits);
  if (!head) {
    behind_ = true;
    return head.failure();
  }
  if (!states_.empty() && head->tick <= states_.back().tick) return Reception::old;
  const sim::State* base = nullptr;
  if (head->kind == PacketKind::delta) {
    base = find(head->base_tick);
    if (!base) {
      behind_ = true;
      return Reception::missed;
    }
  }

  // Decode the packet and append its state.
  auto state = base ? read_delta(*head, *base, settings_.limits) : read_keyframe(*head, settings_.limits);
  if (!state) {
    behind_ = true;
    return state.failure();
  }
  if (state->level_hash != settings_.level_hash.value_or(state->level_hash)) return Reception::foreign;
  states_.push_back(std::move(*state));
  if (states_.size() > kStates) states_.pop_front();
  behind_ = false;
  return Reception::applied;
}

const sim::State* Receiver::find(std::uint32_t tick) const {
  const auto found = std::lower_bound(states_.begin(), states_.end(), tick,
                                      [](const sim::State& s, std::uint32_t t) { return s.tick < t; });
  return found != states_.end() && found->tick == tick ? &*found : nullptr;
}

std::vector<std::byte> Receiver::request() const {
  Request request;
  if (!states_.empty()) request = {states_.back().tick, checksum_of(states_.back())};
  return write_request(request);
}

void Receiver::reset() {
  states_.clear();
  behind_ = false;
}

}  // namespace brume::wire
