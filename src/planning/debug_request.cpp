#include "planning/debug_request.hpp"

#include <cmath>

namespace brume::planning {

ViewSlice slice_through_smoke(const smoke::SmokeVolume* volume, glm::vec3 eye_world, glm::vec3 target_world) {
  const glm::vec3 toward = glm::abs(target_world - eye_world);
  ViewSlice slice{toward.x > toward.z ? 0u : 2u, 0};
  const int axis = static_cast<int>(slice.axis);
  if (!volume || volume->slot_count() == 0) return {slice.axis, target_world[axis]};
  const shared::VolumeLayout& layout = volume->layout();
  const float middle = std::floor(0.5f * (layout.bounds_min[axis] + layout.bounds_max[axis])) + 0.5f;
  slice.at_world = layout.origin_world[axis] + middle * layout.voxel_size;
  return slice;
}

}  // namespace brume::planning
