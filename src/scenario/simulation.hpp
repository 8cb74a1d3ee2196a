// The world and the smoke of a scenario's timeline, at any time.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "smoke/smoke_volume.hpp"
#include "sim/world.hpp"
#include "scenario/events.hpp"
#include "scenario/level_events.hpp"
#include "scenario/scenario.hpp"

namespace brume::scenario {

class Simulation {
 public:
  /// `scenario` must outlive it, its voxels at their place. Fails with bad_input when an event cannot be.
  static Result<std::unique_ptr<Simulation>> create(const Scenario& scenario);

  /// Moves to the tick at or before a time [s], and the smoke with it.
  void advance_to(double seconds);
  const sim::World& world() const { return world_; }
  const smoke::SmokeVolume& volume() const { return volume_; }
  /// The surfaces of the level at the present tick.
  const voxel::PatchedPlanes& planes() const { return planes_; }
  /// Objects of the scene that are open doors at the present tick, rising.
  std::span<const std::uint32_t> hidden_objects() const { return hidden_objects_; }
  /// All changes of the level, by time.
  const std::vector<LevelEvent>& level_events() const { return level_events_; }

  // What changes in a timeline that is written on, at any time, past or to come. The world has it at once;
  // the smoke volume, the planes and the hidden objects have it when advance_to is called next.

  /// Takes more events, each to its place among those that there are, and changes of the level that come
  /// after all that there are. Fails with bad_input for an event that the world does not take: nothing is
  /// taken then.
  Result<void> add(std::vector<OrderedEvent> events, std::vector<LevelEvent> changes);
  /// Becomes the simulation of other events, changes and masks. Only what differs is played again. Fails as
  /// `add` does.
  Result<void> replace(std::vector<OrderedEvent> events, std::vector<LevelEvent> changes,
                       const sim::MaskKey& masks);

 private:
  Simulation(const Scenario& scenario, std::vector<LevelEvent> level_events);
  void follow_level();
  void replace_level(std::vector<LevelEvent> changes);

  std::vector<LevelEvent> level_events_;
  std::size_t in_effect_ = 0;  // of level_events_
  std::vector<std::uint32_t> hidden_objects_;
  sim::World world_;
  std::vector<EventOrder> orders_;  // of the world's log
  voxel::PatchedPlanes planes_;
  smoke::SmokeVolume volume_;
};

}  // namespace brume::scenario
