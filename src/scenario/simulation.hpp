// The world and the smoke of a scenario's timeline at any time.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "planning/next_level.hpp"
#include "scenario/events.hpp"
#include "scenario/level_events.hpp"
#include "scenario/scenario.hpp"
#include "scenario/smoke_report.hpp"
#include "sim/world.hpp"
#include "smoke/field.hpp"

namespace brume::scenario {

class Simulation {
 public:
  /// `scenario` must outlive it, with its voxels and masks at a fixed address. Fails with bad_input for an
  /// invalid event.
  static Result<std::unique_ptr<Simulation>> create(const Scenario& scenario);

  /// Moves world and smoke to the tick at or before a time [s].
  void advance_to(double seconds);
  const sim::World& world() const { return world_; }
  /// What happens to the smokes of its timeline: report_smokes. Moves the world but not the smoke volume;
  /// both are at the same tick again after the next advance_to.
  std::vector<SmokeReport> report_smokes(const Scenario& scenario);
  /// The smoke of the world, with the surfaces of doors and edits.
  const smoke::Field& field() const { return field_; }
  const smoke::SmokeVolume& volume() const { return field_.volume(); }
  /// Scene objects that are open doors at the present tick, ascending.
  std::span<const std::uint32_t> hidden_objects() const { return hidden_objects_; }
  /// The level after the next of its changes, as far as that is known; null: none follows. The same object
  /// until the level changes or is edited.
  std::shared_ptr<const planning::NextLevel> next_level() const;
  /// All changes of the level, sorted by time.
  const std::vector<LevelEvent>& level_events() const { return level_events_; }

  // Edits of a running timeline, at any past or future time. The world changes at once; smoke volume,
  // surfaces and hidden objects follow at the next advance_to.

  /// Adds events, merged into the existing ones by their order, and level changes after all existing ones.
  /// Fails with bad_input for an event that the world rejects; nothing is added then.
  Result<void> add(std::vector<OrderedEvent> events, std::vector<LevelEvent> changes);
  /// Replaces all events, level changes and masks. Replays only from the first difference. Fails as `add`
  /// does.
  Result<void> replace(std::vector<OrderedEvent> events, std::vector<LevelEvent> changes,
                       const sim::MaskKey& masks);

 private:
  Simulation(const Scenario& scenario, std::vector<LevelEvent> level_events);
  void follow_level();
  std::vector<std::uint32_t> hidden_after(std::size_t events) const;

  std::vector<LevelEvent> level_events_;
  std::optional<std::size_t> in_effect_ = 0;  // how many level_events_ show; none: another's show
  std::vector<std::uint32_t> hidden_objects_;
  mutable std::shared_ptr<const planning::NextLevel> next_level_;  // null: yet to be made
  sim::World world_;
  std::vector<EventOrder> orders_;  // sort keys of the world's log, in parallel
  smoke::Field field_;
};

}  // namespace brume::scenario
