#include "api/objects.hpp"
#include "wire/packet.hpp"

namespace brume::api {
namespace {

brume_state_info info_of(const sim::State& state) {
  const auto count = [](const auto& list) { return static_cast<std::uint32_t>(list.size()); };
  return {state.tick,          state.ticks_per_second, state.events,       count(state.flights),
          count(state.clouds), count(state.blasts),    count(state.holes), count(state.bodies)};
}

void save_state(const brume_state& of, void* buffer, std::size_t capacity, std::size_t* size) {
  const std::unique_lock lock(of.mutex);
  if (of.saved.empty()) of.saved = wire::write_keyframe(of.state);
  write_bytes(of.saved.data(), of.saved.size(), buffer, capacity, size);
}

sim::State load_state(const void* bytes, std::size_t size) {
  const std::span data(static_cast<const std::byte*>(bytes), size);
  const wire::PacketHead head = unwrap(wire::read_head(data), BRUME_ERROR_DATA);
  if (head.kind != wire::PacketKind::keyframe) fail(BRUME_ERROR_DATA, "not a saved state");
  return unwrap(wire::read_keyframe(head), BRUME_ERROR_DATA);
}

}  // namespace
}  // namespace brume::api

using namespace brume::api;

extern "C" {

brume_result brume_state_destroy(brume_state* state) BRUME_NOEXCEPT {
  return destroy(__func__, state);
}

brume_result brume_state_describe(const brume_state* state, brume_state_info* info) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) { required(info, "info") = info_of(call.handle(state).state); });
}

brume_result brume_state_hash(const brume_state* state, uint64_t* hash) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const brume_state& of = call.handle(state);
    required(hash, "hash") = of.state.hash();
  });
}

brume_result brume_state_save(const brume_state* state, void* buffer, size_t capacity,
                              size_t* size) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) { save_state(call.handle(state), buffer, capacity, size); });
}

brume_result brume_state_load(brume_context* context, const void* bytes, size_t size,
                              brume_state** state) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const brume_context& owner = call.handle(context);
    required(state, "state");
    required(static_cast<const std::byte*>(bytes), "bytes");
    create(state, owner.settings, load_state(bytes, size));
  });
}

}  // extern "C"
