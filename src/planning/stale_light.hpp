// Which rays of light through the smoke no longer hold, as their smoke, holes or lights changed.
#pragma once

#include "planning/known_lights.hpp"
#include "planning/light_change_tracking.hpp"
#include "planning/smoke_light_pages.hpp"

namespace brume::planning {

/// Compares the inputs of each frame with those of the frame before, and marks what no longer holds.
class StaleLight {
 public:
  /// Marks rays and texel lists; `lights` are still those of the frame before. `is_sliced`: the frame updates
  /// only some phases (UpdateScheduler::is_sliced).
  void mark(const SmokeLightInputs& inputs, const KnownLights& lights, bool is_sliced, SmokeLightPages& pages,
            Allocator memory);
  /// Whether light scatters to another eye, or comes from another sky or other surroundings.
  bool surroundings_changed(const SmokeLightInputs& inputs) const {
    return tracker_.gather_inputs_changed(inputs);
  }
  /// Adds the changes of holes that texels of a brick may be in, of a frame that is sliced: their texels must
  /// have light at once.
  void add_holes_in(glm::ivec3 brick, std::vector<shared::LightChange>& changes) const;

  /// The frame is the one before from now on.
  void store(const SmokeLightInputs& inputs) { tracker_.store_inputs(inputs); }
  /// There is no frame before.
  void reset() { tracker_.reset(); }

 private:
  bool mark_crossed(const SmokeLightInputs& inputs, const KnownLights& lights,
                    std::span<const shared::LightChange> changes, SmokeLightPages& pages) const;

  LightChangeTracker tracker_;
  std::vector<shared::LightChange> holes_;  // that changed in this frame
};

}  // namespace brume::planning
