// A scenario that is edited while it plays: a player's actions are added to its timeline.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/error.hpp"
#include "scenario/scenario.hpp"
#include "scenario/simulation.hpp"
#include "scene/timeline.hpp"

namespace brume::scenario {

/// At any time its simulation equals, state hash for state hash, the simulation of its timeline saved and
/// loaded again, regardless of the edits, their times and their order.
class EditableScenario {
 public:
  /// Starts the scenario's own timeline at time 0. Stores the current grid in the timeline, so that loading
  /// it again gives the same grid. Fails as Simulation::create does.
  static Result<std::unique_ptr<EditableScenario>> create(Scenario scenario);
  EditableScenario(const EditableScenario&) = delete;
  EditableScenario& operator=(const EditableScenario&) = delete;

  /// Its timeline contains all actions. Scene and voxels never change; a change of the masks shows in
  /// MaskAtlas::key of its `masks`.
  const Scenario& scenario() const { return scenario_; }
  const Simulation& simulation() const { return *simulation_; }

  /// Moves to the tick at or before a time [s], forwards or backwards. Throws as SmokeVolume::update.
  void advance_to(double seconds) { simulation_->advance_to(seconds); }

  // The edits below are atomic: they apply completely, or fail with one line. The simulation's world changes
  // at once; smoke volume, planes and hidden objects follow at the next advance_to.

  /// Adds the events of `actions`; its other members are ignored. Times may be past, present and future.
  /// Present and future events are cheap; past ones replay the simulation from their time. A new picture or
  /// text rebuilds all masks. Fails with bad_input as check_events, check_objects and load_masks do, and for
  /// an event that the simulation rejects.
  Result<void> add(const scene::Timeline& actions);

  /// Takes over all of a timeline but its events: how smoke, sky, pictures, volumes, decals and carriers are,
  /// and the path of the camera. A change of the amount or life of smoke replays all of it. Fails with
  /// bad_input as check_settings, load_lens_openings and Volumes::choose_grids do, and for a timeline that
  /// `reset` refuses for its scene, grid or parts.
  Result<void> set_settings(scene::Timeline settings);

  /// Replaces the timeline by another one of the same scene, with the same grid or none, at the present tick.
  /// Fails with bad_input for another scene or grid, for volumes or decals of other files, for carriers of
  /// other objects, for other roles, and as `add` does.
  Result<void> reset(scene::Timeline timeline);

 private:
  explicit EditableScenario(Scenario scenario) : scenario_(std::move(scenario)) {}
  /// The parts of a scenario that a new timeline leaves unchanged.
  struct Unchanged {
    bool masks = false, level = false;
  };
  bool has_masks_of(const scene::Timeline& actions) const;
  bool moves_are_last(const scene::Timeline& actions) const;
  bool changes_are_last(const scene::Timeline& actions) const;
  Result<void> add_in_place(const scene::Timeline& actions);
  Result<void> expect_same_parts(const scene::Timeline& timeline) const;
  Result<void> choose_grids(const std::vector<scene::VolumeOptions>& volumes);
  Result<void> replay(scene::Timeline timeline, const Unchanged& unchanged);
  ObjectLevel& last_level();

  Scenario scenario_;
  std::unique_ptr<Simulation> simulation_;
  BodyNumbers bodies_;
  std::optional<ObjectLevel> last_level_;  // after all changes; created when a door is first used
};

}  // namespace brume::scenario
