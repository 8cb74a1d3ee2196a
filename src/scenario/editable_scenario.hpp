// A scenario that is written while it plays: what a player does goes into its timeline.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/error.hpp"
#include "scene/timeline.hpp"
#include "scenario/simulation.hpp"
#include "scenario/scenario.hpp"

namespace brume::scenario {

/// At every moment its simulation equals, state hash for state hash, the one of the timeline when it is saved
/// and loaded again, whatever was done, at whichever times, in whichever order.
class EditableScenario {
 public:
  /// Plays the scenario's own timeline, at time 0. The timeline now names the grid that it plays on, so that it
  /// stays the same grid when it is loaded again. Fails as Simulation::create does.
  static Result<std::unique_ptr<EditableScenario>> create(Scenario scenario);
  EditableScenario(const EditableScenario&) = delete;
  EditableScenario& operator=(const EditableScenario&) = delete;

  /// Its timeline has all that was done. Scene and voxels stay as they were; masks may become others, which
  /// MaskAtlas::key of its `masks` tells.
  const Scenario& scenario() const { return scenario_; }
  const Simulation& simulation() const { return *simulation_; }

  /// Moves to the tick at or before a time [s], forwards or backwards. Throws as SmokeVolume::update.
  void advance_to(double seconds) { simulation_->advance_to(seconds); }

  // What follows takes all that it is given, or nothing and says why in one line. The world of the simulation
  // has it at once; smoke volume, planes and hidden objects follow when advance_to is called next.

  /// Does what the event lists of `actions` say; its other members do not count. Times may be past, present and
  /// to come. What is to come, or present, costs next to nothing; the past is played again from there on. A
  /// picture or a text that is new makes all masks anew. Fails with bad_input as
  /// check_events, check_doors and load_masks, and for an event that the simulation cannot take.
  Result<void> add(const scene::Timeline& actions);

  /// Of all smokes, those that are there too: what changes them plays them again from the first.
  Result<void> set_smoke(const scene::SmokeOptions& smoke);
  Result<void> set_sky(const scene::SkyOptions& sky);
  /// [EV]
  Result<void> set_exposure(float exposure);
  /// Length of the film [s].
  Result<void> set_duration(float duration);
  /// The path of the camera; by time, no two keys alike.
  Result<void> set_camera(std::vector<scene::CameraKey> keys);

  /// Back to another timeline, of the same scene and the same grid or none, at the present tick. Fails with
  /// bad_input for another scene or grid, and as `add` does.
  Result<void> reset(scene::Timeline timeline);

 private:
  explicit EditableScenario(Scenario scenario) : scenario_(std::move(scenario)) {}
  /// What of a scenario stays when its timeline becomes another.
  struct Kept {
    bool masks = false, level = false;
  };
  bool has_masks_of(const scene::Timeline& actions) const;
  bool moves_are_last(const scene::Timeline& actions) const;
  bool changes_are_last(const scene::Timeline& actions) const;
  Result<void> add_in_place(const scene::Timeline& actions);
  Result<void> replay(scene::Timeline timeline, const Kept& staying);
  ObjectLevel& last_level();

  Scenario scenario_;
  std::unique_ptr<Simulation> simulation_;
  BodyNumbers bodies_;
  std::optional<ObjectLevel> last_level_;  // after all changes; made when a door is first used
};

}  // namespace brume::scenario
