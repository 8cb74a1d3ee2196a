// A stage's timeline as the simulation takes it: integer events, and the world and smoke that they make.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sim/smoke_volume.hpp"
#include "sim/world.hpp"
#include "stage/level_events.hpp"
#include "stage/stage.hpp"

namespace brume::stage {

/// The tick at or before a time [s]; 0 for times before 0. The only place where seconds become ticks.
std::uint32_t tick_at(double seconds, std::uint32_t ticks_per_second = sim::WorldSettings{}.ticks_per_second);

/// The timeline's events in the order in which a world takes them: by tick, and within one tick the edits and
/// doors, the smokes, the shots, the letters of texts, the blasts, the moves. Bodies are numbered in the
/// order of their names' first appearance. Fails with bad_input for an event that is out of the simulation's
/// range, and as level_events.
Result<std::vector<sim::Event>> events_of(
    const Stage& stage, std::uint32_t ticks_per_second = sim::WorldSettings{}.ticks_per_second);

/// The simulation of a stage at any time.
class Simulation {
 public:
  /// `stage` must outlive it. Fails with bad_input when an event cannot be.
  static Result<std::unique_ptr<Simulation>> create(const Stage& stage);

  /// Moves to the tick at or before a time [s], and the smoke with it.
  void advance_to(double seconds);
  const sim::World& world() const { return world_; }
  const sim::SmokeVolume& volume() const { return volume_; }
  /// The surfaces of the level at the present tick.
  const voxel::PatchedPlanes& planes() const { return planes_; }
  /// Objects of the scene that are open doors at the present tick, rising.
  std::span<const std::uint32_t> hidden_objects() const { return hidden_objects_; }

 private:
  Simulation(const Stage& stage, std::vector<LevelEvent> level_events);
  void follow_level();

  std::vector<LevelEvent> level_events_;
  std::size_t in_effect_ = 0;  // of level_events_
  std::vector<std::uint32_t> hidden_objects_;
  sim::World world_;
  voxel::PatchedPlanes planes_;
  sim::SmokeVolume volume_;
};

}  // namespace brume::stage
