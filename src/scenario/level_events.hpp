// The effect of a timeline's doors and edits on the level: its voxels, its planes and its visible objects.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "scenario/scenario.hpp"
#include "sim/level_edit.hpp"
#include "sim/world.hpp"
#include "voxel/level.hpp"
#include "voxel/patched_planes.hpp"

namespace brume::scenario {

struct LevelEvent {
  double time = 0;                                  ///< [s]
  sim::EditBlocks blocks;                           ///< For a sim::LevelEdit; may be empty.
  std::shared_ptr<const voxel::PlanePatch> planes;  ///< Never null.
  std::vector<std::uint32_t> objects;               ///< Scene objects of a door, ascending.
  bool hidden = false;                              ///< Whether they are hidden from now on.
};

/// The level of a scenario with one part per object that stops anything; `part_of[object]` is its part, or
/// scene::kNone of a ghost.
struct ObjectLevel {
  voxel::Level level;
  std::vector<std::uint32_t> part_of;
};
ObjectLevel make_level(const Scenario& scenario);

/// A change as an edit of the simulation; `now` is the level right after it.
sim::EditBlocks make_edit(const voxel::LevelChange& change, const voxel::Solids& now);

/// The voxels with centres inside a box [m].
Box<int> voxels_in(const voxel::GridLayout& layout, glm::vec3 low_world, glm::vec3 high_world);

/// Applies all edits and doors of a timeline to a level in order of time, edits before doors of the same
/// time. The doors must pass check_objects.
std::vector<LevelEvent> apply_level_events(const scene::Timeline& timeline, const scene::Scene& scene,
                                           ObjectLevel& objects);

/// How many of the events, which are sorted by time, are in effect at the world's tick.
std::size_t count_in_effect(std::span<const LevelEvent> events, const sim::World& world);
/// For smoke::Field::set_patches.
std::vector<std::shared_ptr<const voxel::PlanePatch>> patches_of(std::span<const LevelEvent> events);

/// The level events of the scenario's timeline. Fails as check_objects does.
Result<std::vector<LevelEvent>> level_events(const Scenario& scenario);

}  // namespace brume::scenario
