#include "wire/receiver.hpp"

#include <algorithm>
#include <string>

namespace brume::wire {
namespace {

// A reply is relative to the state named in the request; this many packets may overtake it.
constexpr std::size_t kStates = 32;

}  // namespace

Receiver::Receiver(const ReceiverSettings& settings) : settings_(settings) {
  BRUME_ASSERT(settings.hold_ticks <= kMaxHoldTicks, std::to_string(settings.hold_ticks));
}

Result<Reception> Receiver::receive(std::span<const std::byte> packet) {
  const auto head = read_head(packet, settings_.limits);
  if (!head) {
    behind_ = true;
    return head.failure();
  }
  if (!states_.empty() && head->tick <= states_.back().tick) return Reception::old;
  if (head->kind == PacketKind::delta && !find(head->base_tick)) return hold(packet, *head);
  const auto received = apply(*head);
  if (received && *received == Reception::applied) apply_held();
  return received;
}

/// Decodes a packet whose base is there, and appends its state.
Result<Reception> Receiver::apply(const PacketHead& head) {
  auto state = head.kind == PacketKind::delta ? read_delta(head, *find(head.base_tick), settings_.limits)
                                              : read_keyframe(head, settings_.limits);
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

/// Keeps the packets of the latest ticks, also while a state is lost: the answer to a request is the base of
/// those after it.
Reception Receiver::hold(std::span<const std::byte> packet, const PacketHead& head) {
  const auto place = std::ranges::lower_bound(held_, head.tick, {}, &Early::tick);
  if (place != held_.end() && place->tick == head.tick) return Reception::old;
  const bool is_late = !states_.empty() && head.base_tick <= states_.back().tick;
  if (!is_late) held_.insert(place, {head.tick, head.base_tick, {packet.begin(), packet.end()}});
  std::uint64_t bytes = 0;
  for (const Early& early : held_) bytes += early.packet.size();
  while (held_.size() > settings_.hold_ticks || bytes > settings_.limits.max_bytes) {
    bytes -= held_.front().packet.size();
    held_.erase(held_.begin());
  }
  const bool is_held = std::ranges::binary_search(held_, head.tick, {}, &Early::tick);
  if (is_held && !is_lost(head.base_tick)) return Reception::held;
  behind_ = true;
  return Reception::missed;
}

void Receiver::apply_held() {
  bool damaged = false;
  for (const Early& early : held_) {
    if (early.tick <= states_.back().tick || !find(early.base_tick)) continue;
    const auto head = read_head(early.packet, settings_.limits);
    damaged |= !head || !apply(*head);
  }
  // No state will come at or before the newest one.
  std::erase_if(held_, [&](const Early& early) { return early.base_tick <= states_.back().tick; });
  behind_ = damaged || (!held_.empty() && is_lost(held_.back().base_tick));
}

/// Whether a later state counts as lost.
bool Receiver::is_lost(std::uint32_t base_tick) const {
  return states_.empty() || base_tick - states_.back().tick > settings_.hold_ticks;
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
  held_.clear();
  behind_ = false;
}

}  // namespace brume::wire
