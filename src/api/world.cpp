#include <glm/glm.hpp>

#include "api/events.hpp"
#include "api/objects.hpp"

namespace brume::api {
namespace {

void create_world(Call& call, const brume_level* level, const brume_world_params* given,
                  brume_world** world) {
  const brume_level& owner = call.handle(level);
  required(world, "world");
  const brume_world_params params = params_or_defaults(given);
  require(params.ticks_per_second >= 1 && params.ticks_per_second <= 1000,
          "`ticks_per_second` must be from 1 to 1000");
  const auto atlas = atlas_of(call, params.masks);
  const sim::MaskKey masks = atlas ? atlas->key() : sim::MaskKey{};
  create(world, owner.settings, owner.data,
         sim::WorldSettings{params.ticks_per_second, masks, owner.data->hash});
}

/// Changes the log: `change(world, events)`, where only history can still fail.
template <typename Change>
void change_log(Call& call, brume_world* world, const brume_event* events, std::size_t count, Change change) {
  brume_world& object = call.handle(world);
  call.change(object, [&] {
    std::vector<sim::Event> log =
        events_of(events, count, object.level->grid.layout(), object.world->settings().masks.count);
    unwrap(change(*object.world, std::move(log)), BRUME_ERROR_HISTORY);
  });
}

void advance(brume_world& world, std::uint32_t tick) {
  require(tick <= sim::kMaxTick, "`tick` must be at most 536870912");
  const std::uint32_t earliest = world.world->earliest_tick();
  if (tick < earliest)
    fail(BRUME_ERROR_HISTORY, "history before tick " + std::to_string(earliest) + " was dropped");
  world.world->advance_to(tick);
}

/// Restores a state into a new world where the present one is broken.
void restore(brume_world& world, const sim::State& state) {
  if (const auto reason = sim::foreign_reason(state, world.world->state(), "the world"))
    fail(BRUME_ERROR_MISMATCH, *reason);
  const sim::WorldSettings settings = world.world->settings();
  if (world.broken) world.world.emplace(world.level->solids(), settings);
  unwrap(world.world->restore(state), BRUME_ERROR_DATA);
}

/// Reads a number of a world.
template <typename Number, typename Read>
brume_result read_number(const char* function, const brume_world* world, Number* out, Read read) noexcept {
  return Call(function).run([&](Call& call) {
    const brume_world& object = call.handle(world);
    required(out, "the output");
    call.read(object, [&] { *out = read(*object.world); });
  });
}

}  // namespace
}  // namespace brume::api

using namespace brume::api;
using brume::sim::World;

extern "C" {

brume_result brume_position_from_metres(double x, double y, double z,
                                        brume_position* position) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call&) {
    required(position, "position");
    const auto at = brume::sim::position_from_metres({x, y, z});
    require(glm::all(glm::lessThanEqual(glm::abs(at), glm::ivec3(brume::sim::kMaxCoordinate))),
            "coordinates must be finite and within 16384 m of the world's origin");
    *position = {at.x, at.y, at.z};
  });
}

brume_result brume_world_create(const brume_level* level, const brume_world_params* params,
                                brume_world** world) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) { create_world(call, level, params, world); });
}

brume_result brume_world_destroy(brume_world* world) BRUME_NOEXCEPT {
  return destroy(__func__, world);
}

brume_result brume_world_append(brume_world* world, const brume_event* events, size_t count) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    change_log(call, world, events, count, [](World& simulation, std::vector<brume::sim::Event> log) {
      return simulation.append(std::move(log));
    });
  });
}

brume_result brume_world_replace_from(brume_world* world, uint32_t tick, const brume_event* events,
                                      size_t count) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    require(tick <= brume::sim::kMaxTick, "`tick` must be at most 536870912");
    change_log(call, world, events, count, [&](World& simulation, std::vector<brume::sim::Event> log) {
      for (const brume::sim::Event& event : log)
        require(brume::sim::tick_of(event) >= tick, "each event must be of `tick` or later");
      return simulation.replace_from(tick, std::move(log));
    });
  });
}

brume_result brume_world_advance_to(brume_world* world, uint32_t tick) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    brume_world& object = call.handle(world);
    call.change(object, [&] { advance(object, tick); });
  });
}

brume_result brume_world_step(brume_world* world) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    brume_world& object = call.handle(world);
    call.change(object, [&] { advance(object, object.world->tick() + 1); });
  });
}

brume_result brume_world_tick(const brume_world* world, uint32_t* tick) BRUME_NOEXCEPT {
  return read_number(__func__, world, tick, [](const World& simulation) { return simulation.tick(); });
}

brume_result brume_world_earliest_tick(const brume_world* world, uint32_t* tick) BRUME_NOEXCEPT {
  return read_number(__func__, world, tick,
                     [](const World& simulation) { return simulation.earliest_tick(); });
}

brume_result brume_world_hash(const brume_world* world, uint64_t* hash) BRUME_NOEXCEPT {
  return read_number(__func__, world, hash, [](const World& simulation) { return simulation.state_hash(); });
}

brume_result brume_world_forget_before(brume_world* world, uint32_t tick) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    brume_world& object = call.handle(world);
    call.change(object, [&] { object.world->forget_before(tick); });
  });
}

brume_result brume_world_state(const brume_world* world, brume_state** state) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const brume_world& object = call.handle(world);
    required(state, "state");
    call.read(object, [&] { create(state, object.settings, object.world->state()); });
  });
}

brume_result brume_world_restore(brume_world* world, const brume_state* state) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    brume_world& object = call.handle(world);
    const brume_state& from = call.handle(state);
    call.change(
        object, [&] { restore(object, from.state); }, true);
  });
}

}  // extern "C"
