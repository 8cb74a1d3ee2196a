// The smoke of a world up to the surfaces of walls, as a volume grid in the simulation's own voxels.
#pragma once

#include <vector>

#include "scenario/level_events.hpp"
#include "scenario/smoke_grid.hpp"
#include "sim/world.hpp"
#include "smoke/smoke_volume.hpp"
#include "voxel/patched_planes.hpp"

namespace brume::scenario {

/// smoke_grid, with what lies between the last free voxels and the surfaces of walls, where voxels are solid: it
/// is added to the voxels with smoke that are visible from there, so that linear interpolation of the grid has
/// the optical depth of the smoke as it is drawn without noise, along any path from wall to wall. No voxel
/// without smoke gets any. Values beside walls reach 2, in corners more. `planes`: those of the volume.
grids::Grid smoke_grid_up_to_walls(const smoke::SmokeVolume& volume, const smoke::PlaneSource& planes,
                                   const sim::State& state, const SmokeGridOptions& options);

/// The same of a scenario's world of any tick rate, with the surfaces of its doors and edits.
class FollowedSmoke {
 public:
  /// `scenario` must outlive it. Throws what level_events fails with.
  explicit FollowedSmoke(const Scenario& scenario);
  FollowedSmoke(const FollowedSmoke&) = delete;
  FollowedSmoke& operator=(const FollowedSmoke&) = delete;
  /// At the world's tick, which never falls from call to call.
  grids::Grid grid(const sim::World& world, const SmokeGridOptions& options);

 private:
  std::vector<LevelEvent> level_events_;
  std::size_t in_effect_ = 0;  // number of level_events_ in effect
  voxel::PatchedPlanes planes_;
  smoke::PlaneSource source_;
  smoke::SmokeVolume volume_;
};

}  // namespace brume::scenario
