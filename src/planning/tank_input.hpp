// Tanks of spheres in a frame.
#pragma once

#include <glm/glm.hpp>
#include <memory>

#include "scene/tank_illumination.hpp"

namespace brume::planning {

/// Where a tank is in a world: turned, scaled and moved.
struct TankPlacement {
  glm::mat3 axes{1};            ///< Unit vectors at right angles, right-handed: the tank's axes in the world.
  glm::vec3 position_world{0};  ///< The tank's middle.
  float scale = 1;              ///< > 0

  bool operator==(const TankPlacement&) const = default;
};
/// A tank in a frame.
struct TankInput {
  std::shared_ptr<const scene::TankContent> content;
  std::shared_ptr<const scene::TankIllumination> light;
  TankPlacement placement;
  scene::TankView view = scene::TankView::spheres;
  std::uint32_t samples = 1;  ///< Paths of each pixel in this frame, > 0.
  std::uint32_t index =
      0;  ///< The first one's number, where the picture begins: another one has other noise.
  /// The surfaces before the tank are the same as in the frame before: samples are added to it, where all
  /// else is the same, too. Of a level of the renderer's own, it compares them itself.
  bool continues = false;
};

}  // namespace brume::planning
