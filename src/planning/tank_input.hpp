// Tanks of spheres in a frame.
#pragma once

#include <memory>

#include "planning/tank_plan.hpp"
#include "spheres/brick_lists.hpp"

namespace brume::planning {

/// A tank, which does not change.
struct TankContent {
  spheres::Tank tank;
  spheres::BrickLists bricks;
};
/// What it is lit by, which does not change either.
struct TankLight {
  scene::TankScene scene;  ///< Lights, glass, fog, bounces and Sky::ambient, as they are at the start.
  spheres::LightPaths paths;
};

/// A tank in a frame.
struct TankInput {
  std::shared_ptr<const TankContent> content;
  std::shared_ptr<const TankLight> light;
  TankPlacement placement;
  scene::TankView view = scene::TankView::spheres;
  std::uint32_t samples = 1;  ///< Paths of each pixel in this frame, > 0.
  std::uint32_t index = 0;    ///< Of the first one, where the picture begins: another one has other noise.
  /// The frame's surfaces before the tank are those of the frame before: samples are added to it, where all
  /// else is the same, too.
  bool continues = false;
};

}  // namespace brume::planning
