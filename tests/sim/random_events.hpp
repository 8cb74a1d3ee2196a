// Random events of every kind of the simulation.
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <variant>
#include <vector>

#include "sim/event_fields.hpp"
#include "sim/level_edit.hpp"

namespace brume::sim {

/// Draws the fields of an event: places of the level, and numbers near the low ends of their ranges, so that
/// what happens is small and short. Choices stay. A visitor of sim/event_fields.hpp.
struct EventDrawing {
  std::mt19937& random;
  const voxel::GridLayout& layout;

  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(random() % count); }
  glm::ivec3 voxel() {
    glm::ivec3 voxel;
    for (int axis = 0; axis < 3; ++axis)
      voxel[axis] = static_cast<int>(below(static_cast<std::uint32_t>(layout.size[axis])));
    return voxel;
  }
  void operator()(const PositionField&, Position& position) { position = VoxelRuler(layout).centre(voxel()); }
  void operator()(const NumberField& field, std::uint32_t& number) {
    const auto low = static_cast<std::uint32_t>(field.low);
    if (below(4) == 0) return void(number = low);
    number =
        low + below(static_cast<std::uint32_t>(std::min<std::uint64_t>(field.high - field.low, 1000)) + 1);
  }
  void operator()(const ChoiceField&, const auto&) {}
};

/// An event of a kind, before a tick.
template <typename Kind>
Kind random_event(std::mt19937& random, const voxel::GridLayout& layout, std::uint32_t end) {
  EventDrawing draw{random, layout};
  Kind event;
  do {
    event = {};
    event.tick = draw.below(end);
    visit_fields(event, draw);
    if constexpr (requires { event.blocks; }) {
      const glm::ivec3 low = draw.voxel();
      event.blocks = edit_box(layout, low, low + 3, draw.below(2) == 0);
    }
  } while (!check_event(event, layout));
  return event;
}

/// So many events of each kind, before a tick.
template <typename... Kinds>
std::vector<Event> random_events(const std::variant<Kinds...>&, unsigned seed,
                                 const voxel::GridLayout& layout, int count, std::uint32_t end) {
  std::mt19937 random(seed);
  std::vector<Event> events;
  for (int i = 0; i < count; ++i) (events.emplace_back(random_event<Kinds>(random, layout, end)), ...);
  return events;
}
inline std::vector<Event> random_events(unsigned seed, const voxel::GridLayout& layout, int count,
                                        std::uint32_t end) {
  return random_events(Event(), seed, layout, count, end);
}

}  // namespace brume::sim
