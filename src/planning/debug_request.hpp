// Which debug view a frame shows instead of the rendered image (docs/reference/command-line.md).
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "shared/debug_view.h"
#include "smoke/smoke_volume.hpp"

namespace brume::planning {

enum class DebugView : std::uint32_t {
  none = shared::kViewNone,  ///< The rendered image itself.
  solid = shared::kViewSolid,
  distance = shared::kViewDistance,
  density = shared::kViewDensity,
  light = shared::kViewLight,
  holes = shared::kViewHoles,
  steps = shared::kViewSteps,
  bricks = shared::kViewBricks,
  normals = shared::kViewNormals,
  albedo = shared::kViewAlbedo,
  depth = shared::kViewDepth,
  overdraw = shared::kViewOverdraw,
};

/// A plane across an axis of the world: density and light are shown on it, distances on its far side.
struct ViewSlice {
  std::uint32_t axis = 1;  ///< 0, 1 or 2: x, y or z.
  float at_world = 1.2f;   ///< [m]
  bool operator==(const ViewSlice&) const = default;
};

/// The slice across x or z that faces the eye most, through the middle of the smoke and of its voxels;
/// without smoke (null: none) through the target.
ViewSlice slice_through_smoke(const smoke::SmokeVolume* volume, glm::vec3 eye_world, glm::vec3 target_world);

struct DebugRequest {
  DebugView view = DebugView::none;
  std::optional<ViewSlice> slice;  ///< Empty: slice_through_smoke.
};

}  // namespace brume::planning
