// The sender and receiver of packets.
#include <algorithm>
#include <array>
#include <cstddef>

#include "api/objects.hpp"
#include "wire/packet.hpp"

namespace brume::api {

// The size of 0.1 and 0.2.
template <>
inline constexpr std::array kEarlierSizes<brume_receiver_params>{
    std::uint32_t{offsetof(brume_receiver_params, level)}};

namespace {

static_assert(static_cast<int>(wire::Reception::missed) == BRUME_RECEPTION_MISSED &&
              static_cast<int>(wire::Reception::held) == BRUME_RECEPTION_HELD);

constexpr std::uint32_t kMaxHistory = 65536;
/// Longer bytes are no request.
constexpr std::size_t kMaxRequest = 16;

std::span<const std::byte> bytes_of(const void* bytes, std::size_t size) {
  if (size > 0) required(static_cast<const std::byte*>(bytes), "bytes");
  return {static_cast<const std::byte*>(bytes), size};
}

void push(brume_sender& sender, const sim::State& state) {
  if (sender.last) {
    if (state.tick <= sender.last->tick)
      fail(BRUME_ERROR_ORDER, "expected a state after tick " + std::to_string(sender.last->tick) +
                                  ", not of tick " + std::to_string(state.tick));
    const bool is_new = state.events < sender.last->events;
    if (const auto reason = sim::foreign_reason(state, *sender.last, "the last state"); reason && !is_new)
      fail(BRUME_ERROR_MISMATCH, *reason);
  }
  sender.packet = unwrap(sender.sender.push(state));
  sender.last = state;
  sender.request.clear();
}

void answer(brume_sender& sender, std::span<const std::byte> request, void* buffer, std::size_t capacity,
            std::size_t* size) {
  if (!sender.last) fail(BRUME_ERROR_ORDER, "no state has been pushed yet");
  if (request.size() > kMaxRequest || request.empty()) fail(BRUME_ERROR_DATA, "not a request");
  // Both calls of one query, and receivers that have the same state, get the answer that is there.
  if (!std::ranges::equal(request, sender.request)) {
    sender.request.clear();
    sender.answer = unwrap(sender.sender.answer(request), BRUME_ERROR_DATA);
    sender.request.assign(request.begin(), request.end());
  }
  write_bytes(sender.answer.data(), sender.answer.size(), buffer, capacity, size);
}

wire::ReceiverSettings settings_of(Call& call, const brume_receiver_params* given) {
  const auto most = defaults<brume_receiver_params>();
  const brume_receiver_params params = params_or_defaults(given);
  require(params.max_bytes >= 1 && params.max_bytes <= most.max_bytes, "`max_bytes` must be from 1 to 2^24");
  require(params.max_voxels >= 1 && params.max_voxels <= most.max_voxels,
          "`max_voxels` must be from 1 to 2^26");
  require(params.max_items >= 1 && params.max_items <= most.max_items, "`max_items` must be from 1 to 2^20");
  require(params.hold_ticks <= wire::kMaxHoldTicks, "`hold_ticks` must be at most 64");
  wire::ReceiverSettings settings{{params.max_bytes, params.max_voxels, params.max_items}};
  settings.hold_ticks = params.hold_ticks;
  if (params.level) settings.level_hash = call.handle(params.level).data->hash;
  return settings;
}

}  // namespace
}  // namespace brume::api

using namespace brume::api;

extern "C" {

brume_result brume_sender_create(brume_context* context, const brume_sender_params* params,
                                 brume_sender** sender) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const brume_context& owner = call.handle(context);
    required(sender, "sender");
    const std::uint32_t history = params_or_defaults(params).history;
    require(history >= 1 && history <= kMaxHistory, "`history` must be from 1 to 65536");
    create(sender, owner.settings, brume::wire::SenderSettings{history});
  });
}

brume_result brume_sender_destroy(brume_sender* sender) BRUME_NOEXCEPT {
  return destroy(__func__, sender);
}

brume_result brume_sender_push(brume_sender* sender, const brume_state* state) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    brume_sender& object = call.handle(sender);
    const brume_state& next = call.handle(state);
    call.change(object, [&] { push(object, next.state); });
  });
}

brume_result brume_sender_packet(const brume_sender* sender, void* buffer, size_t capacity,
                                 size_t* size) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const brume_sender& object = call.handle(sender);
    call.read(object, [&] {
      if (!object.last) fail(BRUME_ERROR_ORDER, "no state has been pushed yet");
      write_bytes(object.packet.data(), object.packet.size(), buffer, capacity, size);
    });
  });
}

brume_result brume_sender_answer(brume_sender* sender, const void* request, size_t request_size, void* buffer,
                                 size_t capacity, size_t* size) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    brume_sender& object = call.handle(sender);
    call.change(object, [&] { answer(object, bytes_of(request, request_size), buffer, capacity, size); });
  });
}

brume_result brume_receiver_create(brume_context* context, const brume_receiver_params* params,
                                   brume_receiver** receiver) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const brume_context& owner = call.handle(context);
    required(receiver, "receiver");
    create(receiver, owner.settings, settings_of(call, params));
  });
}

brume_result brume_receiver_destroy(brume_receiver* receiver) BRUME_NOEXCEPT {
  return destroy(__func__, receiver);
}

brume_result brume_receiver_receive(brume_receiver* receiver, const void* packet, size_t size,
                                    uint32_t* reception) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    brume_receiver& object = call.handle(receiver);
    call.change(object, [&] {
      const auto became = unwrap(object.receiver.receive(bytes_of(packet, size)), BRUME_ERROR_DATA);
      if (became == brume::wire::Reception::foreign)
        fail(BRUME_ERROR_MISMATCH, "the packet is of another level than the receiver's; load the sender's");
      if (reception) *reception = static_cast<std::uint32_t>(became);
    });
  });
}

brume_result brume_receiver_behind(const brume_receiver* receiver, uint32_t* behind) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const brume_receiver& object = call.handle(receiver);
    required(behind, "behind");
    call.read(object, [&] { *behind = object.receiver.behind() ? 1 : 0; });
  });
}

brume_result brume_receiver_request(const brume_receiver* receiver, void* buffer, size_t capacity,
                                    size_t* size) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const brume_receiver& object = call.handle(receiver);
    call.read(object, [&] {
      const std::vector<std::byte> request = object.receiver.request();
      write_bytes(request.data(), request.size(), buffer, capacity, size);
    });
  });
}

brume_result brume_receiver_state(const brume_receiver* receiver, brume_state** state) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const brume_receiver& object = call.handle(receiver);
    required(state, "state");
    call.read(object, [&] {
      if (!object.receiver.state()) fail(BRUME_ERROR_ORDER, "no state has been received yet");
      create(state, object.settings, *object.receiver.state());
    });
  });
}

brume_result brume_receiver_reset(brume_receiver* receiver) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    brume_receiver& object = call.handle(receiver);
    call.change(
        object, [&] { object.receiver.reset(); }, true);
  });
}

}  // extern "C"
