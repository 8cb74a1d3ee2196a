#include <limits>

#include "api/objects.hpp"
#include "sim/state_filter.hpp"
#include "wire/packet.hpp"

namespace brume::api {
namespace {

constexpr std::size_t kMostBoxes = 4096;

brume_state_info info_of(const sim::State& state) {
  const auto count = [](const auto& list) { return static_cast<std::uint32_t>(list.size()); };
  return {state.tick,          state.ticks_per_second, state.events,       count(state.flights),
          count(state.clouds), count(state.blasts),    count(state.holes), count(state.bodies)};
}

void save_state(const brume_state& state, void* buffer, std::size_t capacity, std::size_t* size) {
  const std::unique_lock lock(state.mutex);
  if (state.saved.empty()) state.saved = wire::write_keyframe(state.state);
  write_bytes(state.saved.data(), state.saved.size(), buffer, capacity, size);
}

sim::State load_state(const void* bytes, std::size_t size) {
  const std::span data(static_cast<const std::byte*>(bytes), size);
  const wire::PacketHead head = unwrap(wire::read_head(data), BRUME_ERROR_DATA);
  if (head.kind != wire::PacketKind::keyframe) fail(BRUME_ERROR_DATA, "not a saved state");
  return unwrap(wire::read_keyframe(head), BRUME_ERROR_DATA);
}

sim::State filter_state(const sim::State& state, const brume_box* boxes, std::size_t count) {
  require(count <= kMostBoxes, "at most 4096 boxes");
  if (count > 0) required(boxes, "boxes");
  const auto voxel_of = [&](const brume_point& p) {
    const glm::dvec3 at =
        (glm::dvec3(p.x, p.y, p.z) - glm::dvec3(state.layout.origin_world)) / double{state.layout.voxel_size};
    return glm::ivec3(glm::floor(at));
  };
  std::vector<Box<int>> voxels;
  for (std::size_t i = 0; i < count; ++i) {
    const auto& [low, high] = boxes[i];
    if (!is_in_world(low) || !is_in_world(high) || low.x > high.x || low.y > high.y || low.z > high.z)
      refuse(
          "box " + std::to_string(i) +
          " must have finite coordinates within 16384 m of the world's origin, and `low` not above `high`");
    voxels.push_back({voxel_of(low), voxel_of(high) + 1});
  }
  return sim::filtered(state, voxels);
}

brume_voxel to_voxel(const glm::ivec3& v) {
  return {v.x, v.y, v.z};
}

brume_position position_of(const sim::Position& p) {
  return {p.x, p.y, p.z};
}

std::vector<brume_grenade> list_grenades(const sim::State& state) {
  const std::vector<sim::Grenade> shown = sim::grenades_of(state);
  std::vector<brume_grenade> list;
  for (std::size_t i = 0; i < state.flights.size(); ++i) {
    const sim::Flight& flight = state.flights[i];
    const glm::vec3& at = shown[i].position_world;
    list.push_back(
        {flight.id, flight.throw_tick, flight.detonation_tick, to_voxel(flight.landing), {at.x, at.y, at.z}});
  }
  return list;
}

std::vector<brume_cloud> list_clouds(const sim::State& state) {
  std::vector<brume_cloud> list;
  for (const sim::LiveCloud& live : state.clouds) {
    const sim::CloudOrigin& origin = live.cloud->origin();
    list.push_back({live.id, origin.detonation_tick, live.cloud->end_tick(), to_voxel(origin.source),
                    to_voxel(live.cloud->low()), to_voxel(live.cloud->high() + 1)});
  }
  return list;
}

std::vector<brume_blast> list_blasts(const sim::State& state) {
  std::vector<brume_blast> list;
  for (const sim::LiveBlast& live : state.blasts)
    list.push_back({live.id, live.field->event().tick, live.field->end_tick(),
                    position_of(live.field->centre()), live.field->event().radius});
  return list;
}

std::vector<brume_hole> list_holes(const sim::State& state) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();
  std::vector<brume_hole> list;
  for (const sim::BulletHole& hole : state.holes)
    list.push_back({hole.id, hole.shot.tick, position_of(hole.shot.origin), position_of(hole.shot.toward),
                    hole.shot.radius, static_cast<std::uint32_t>(std::min(hole.distance, kMost)),
                    static_cast<std::uint32_t>(hole.shot.shape), hole.shot.mask, hole.shot.roll});
  return list;
}

std::vector<brume_body> list_bodies(const sim::State& state) {
  std::vector<brume_body> list;
  for (const sim::Body& body : state.bodies)
    list.push_back(
        {body.body, body.tick, body.previous_tick, position_of(body.position), position_of(body.previous)});
  return list;
}

template <typename T, typename List>
brume_result write_state(const char* function, const brume_state* state, T* out, std::size_t capacity,
                         std::size_t* count, List list) noexcept {
  return Call(function).run([&](Call& call) {
    const std::vector<T> all = list(call.handle(state).state);
    write_list(std::span<const T>(all), out, capacity, count);
  });
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
    const brume_state& object = call.handle(state);
    required(hash, "hash") = object.state.hash();
  });
}

brume_result brume_state_save(const brume_state* state, void* buffer, size_t capacity,
                              size_t* size) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) { save_state(call.handle(state), buffer, capacity, size); });
}

brume_result brume_state_filter(const brume_state* state, const brume_box* boxes, size_t box_count,
                                brume_state** filtered) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const brume_state& whole = call.handle(state);
    required(filtered, "filtered");
    create(filtered, whole.settings, filter_state(whole.state, boxes, box_count));
  });
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

brume_result brume_state_grenades(const brume_state* state, brume_grenade* grenades, size_t capacity,
                                  size_t* count) BRUME_NOEXCEPT {
  return write_state(__func__, state, grenades, capacity, count, list_grenades);
}

brume_result brume_state_clouds(const brume_state* state, brume_cloud* clouds, size_t capacity,
                                size_t* count) BRUME_NOEXCEPT {
  return write_state(__func__, state, clouds, capacity, count, list_clouds);
}

brume_result brume_state_blasts(const brume_state* state, brume_blast* blasts, size_t capacity,
                                size_t* count) BRUME_NOEXCEPT {
  return write_state(__func__, state, blasts, capacity, count, list_blasts);
}

brume_result brume_state_holes(const brume_state* state, brume_hole* holes, size_t capacity,
                               size_t* count) BRUME_NOEXCEPT {
  return write_state(__func__, state, holes, capacity, count, list_holes);
}

brume_result brume_state_bodies(const brume_state* state, brume_body* bodies, size_t capacity,
                                size_t* count) BRUME_NOEXCEPT {
  return write_state(__func__, state, bodies, capacity, count, list_bodies);
}

}  // extern "C"
