// The smoke of a world up to the surfaces of walls, as a volume grid in the simulation's own voxels.
#pragma once

#include <vector>

#include "scenario/level_events.hpp"
#include "scenario/smoke_grid.hpp"
#include "sim/world.hpp"
#include "smoke/field.hpp"

namespace brume::scenario {

/// smoke_grid, with what lies between the last free voxels and the surfaces of walls, where voxels are solid:
/// it is added to the voxels with smoke that are visible from there, so that linear interpolation of the grid
/// has the optical depth of the smoke as it is drawn without noise, along any path from wall to wall. No
/// voxel without smoke gets any. Values beside walls reach 2, in corners more.
grids::Grid smoke_grid_up_to_walls(const smoke::Field& field, const SmokeGridOptions& options);

/// The same of a scenario's world of any tick rate, with the surfaces of its doors and edits.
class FollowedSmoke {
 public:
  /// `scenario` must outlive it. Throws what level_events fails with.
  explicit FollowedSmoke(const Scenario& scenario);
  FollowedSmoke(const FollowedSmoke&) = delete;
  FollowedSmoke& operator=(const FollowedSmoke&) = delete;
  /// At the world's tick.
  grids::Grid grid(const sim::World& world, const SmokeGridOptions& options);

 private:
  std::vector<LevelEvent> level_events_;
  smoke::Field field_;
};

}  // namespace brume::scenario
