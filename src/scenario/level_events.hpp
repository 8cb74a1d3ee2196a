// What the doors and edits of a timeline do to the level: to its voxels, its planes, and the picture.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/error.hpp"
#include "sim/level_edit.hpp"
#include "scenario/scenario.hpp"
#include "voxel/level.hpp"
#include "voxel/patched_planes.hpp"

namespace brume::scenario {

struct LevelEvent {
  double time = 0;                                  ///< [s]
  sim::EditBlocks blocks;                           ///< For a sim::LevelEdit; may be empty.
  std::shared_ptr<const voxel::PlanePatch> planes;  ///< Never null.
  std::vector<std::uint32_t> objects;               ///< Of the scene, rising: those of a door.
  bool hidden = false;                              ///< Whether they are out of the picture from now on.
};

/// The level of a scenario with a part for each object; `part_of[object]` is its part, or scene::kNone for one
/// that is not voxelized.
struct ObjectLevel {
  voxel::Level level;
  std::vector<std::uint32_t> part_of;
};
ObjectLevel make_level(const Scenario& scenario);

/// A change as the simulation takes it; `now` is the level's grid right after it.
sim::EditBlocks edit_of(const voxel::LevelChange& change, const voxel::BitGrid& now);

/// The voxels whose centres lie in a box [m].
voxel::IntBox voxels_in(const voxel::GridLayout& layout, glm::vec3 low_world, glm::vec3 high_world);

/// Makes all edits and doors of a timeline happen to a level, by time; of the same time the edits first. The
/// doors must pass check_doors.
std::vector<LevelEvent> apply_level_events(const scene::Timeline& timeline, const scene::Scene& scene,
                                           ObjectLevel& objects);

/// All of the scenario's timeline. Fails as check_doors does.
Result<std::vector<LevelEvent>> level_events(const Scenario& scenario);

}  // namespace brume::scenario
