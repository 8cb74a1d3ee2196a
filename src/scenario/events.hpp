// Converts timelines to the integer events of a world, in the order in which they happen.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "scenario/level_events.hpp"
#include "scenario/scenario.hpp"
#include "scenario/ticks.hpp"
#include "sim/world.hpp"

namespace brume::scenario {

/// The order of kinds of events within one tick: 0 for changes of the level, then from 1 on as
/// scene::for_each_event_kind lists them.
using EventKind = std::uint8_t;

/// Sort key of an event. Events with equal keys keep their timeline order.
struct EventOrder {
  std::uint32_t tick = 0;
  EventKind kind = 0;
  double time = 0;  ///< Time of the timeline's event [s]; the same for all letters of a text.
  auto operator<=>(const EventOrder&) const = default;
};

struct OrderedEvent {
  EventOrder order;
  sim::Event event;
};

/// The numbers of bodies in the world, by name.
class BodyNumbers {
 public:
  /// The number of a body; a new one gets the next number.
  std::uint32_t operator[](const std::string& name) {
    return numbers_.emplace(name, static_cast<std::uint32_t>(numbers_.size())).first->second;
  }
  bool operator==(const BodyNumbers&) const = default;

 private:
  std::map<std::string, std::uint32_t> numbers_;
};
/// Numbers the bodies in the order of their first appearance.
BodyNumbers number_bodies(const scene::Timeline& timeline);

/// Settings that determine events besides the timeline's event lists.
struct EventSettings {
  const voxel::GridLayout& layout;
  const scene::SmokeOptions& smoke;
  const ShotMasks& masks;
  const Scenario& level;  ///< Its surfaces decide where placed smoke begins (smoke_start.hpp).
  std::uint32_t ticks_per_second = sim::WorldSettings{}.ticks_per_second;
};

/// The edits of level changes and a timeline's other events (all but edits and doors), in order. `masks` must
/// contain all masks they use. Fails with bad_input for an event outside the simulation's range.
Result<std::vector<OrderedEvent>> ordered_events(const scene::Timeline& timeline,
                                                 const std::vector<LevelEvent>& changes, BodyNumbers& bodies,
                                                 const EventSettings& settings);

/// The timeline's events in the order of a world's log: by tick, and within one tick edits and doors,
/// then all others in the order of EventKind. Bodies are numbered in the order of their first appearance.
/// Fails with bad_input for an event outside the simulation's range, and as level_events.
Result<std::vector<sim::Event>> events_of(
    const Scenario& scenario, std::uint32_t ticks_per_second = sim::WorldSettings{}.ticks_per_second);

/// The events without their sort keys.
std::vector<sim::Event> without_order(std::vector<OrderedEvent> events);

}  // namespace brume::scenario
