// What a timeline says, as a world takes it: integer events in the order in which they happen.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "sim/world.hpp"
#include "scenario/level_events.hpp"
#include "scenario/scenario.hpp"

namespace brume::scenario {

/// The tick at or before a time [s]; 0 for times before 0. The only place where seconds become ticks.
std::uint32_t tick_at(double seconds, std::uint32_t ticks_per_second = sim::WorldSettings{}.ticks_per_second);

/// Kinds of events in the order in which they happen within one tick.
enum class EventKind : std::uint8_t { level, smoke, shot, letter, blast, move };

/// What the place of an event among others follows from. Of equal ones the first in the timeline comes first.
struct EventOrder {
  std::uint32_t tick = 0;
  EventKind kind = EventKind::level;
  double time = 0;  ///< Of the timeline's event [s]: of all letters of a text the same.
  auto operator<=>(const EventOrder&) const = default;
};

struct OrderedEvent {
  EventOrder order;
  sim::Event event;
};

/// The numbers that bodies have in the world, by their names.
class BodyNumbers {
 public:
  /// Of a body; one that is new gets the next number.
  std::uint32_t operator[](const std::string& name) {
    return numbers_.emplace(name, static_cast<std::uint32_t>(numbers_.size())).first->second;
  }
  bool operator==(const BodyNumbers&) const = default;

 private:
  std::map<std::string, std::uint32_t> numbers_;
};
/// Numbered in the order of their names' first appearance.
BodyNumbers number_bodies(const scene::Timeline& timeline);

/// What the events of a timeline become that follows from elsewhere.
struct EventSettings {
  const voxel::GridLayout& layout;
  const scene::SmokeOptions& smoke;
  const ShotMasks& masks;
  std::uint32_t ticks_per_second = sim::WorldSettings{}.ticks_per_second;
};

/// The edits of a level's changes, and a timeline's events without its edits and doors, in order. `masks`
/// must have all that they name. Fails with bad_input for an event that is out of the simulation's range.
Result<std::vector<OrderedEvent>> ordered_events(const scene::Timeline& timeline,
                                                 const std::vector<LevelEvent>& changes, BodyNumbers& bodies,
                                                 const EventSettings& settings);

/// The timeline's events in the order in which a world takes them: by tick, and within one tick the edits and
/// doors, the smokes, the shots, the letters of texts, the blasts, the moves. Bodies are numbered in the
/// order of their names' first appearance. Fails with bad_input for an event that is out of the simulation's
/// range, and as level_events.
Result<std::vector<sim::Event>> events_of(
    const Scenario& scenario, std::uint32_t ticks_per_second = sim::WorldSettings{}.ticks_per_second);

/// The events alone.
std::vector<sim::Event> without_order(std::vector<OrderedEvent> events);

}  // namespace brume::scenario
