// Tanks as frames show them: their spheres, and the light that falls on them.
#pragma once

#include <glm/glm.hpp>

#include "scene/tank_scene.hpp"
#include "spheres/brick_lists.hpp"
#include "spheres/light_paths.hpp"
#include "spheres/tank.hpp"

namespace brume::scene {

/// A tank, which does not change.
struct TankContent {
  spheres::Tank tank;
  spheres::BrickLists bricks;
};

/// What it is lit by, which does not change either.
struct TankIllumination {
  TankScene scene;  ///< Lights, glass, fog, bounces and Sky::ambient, as they are at the start.
  spheres::LightPaths paths;
};

/// From metres around the tank's middle to voxels from its low corner.
struct TankVoxels {
  float per_metre;
  glm::vec3 middle;
  explicit TankVoxels(const spheres::Tank& tank)
      : per_metre(1 / tank.voxel), middle(0.5f * glm::vec3(tank.size)) {}
  glm::vec3 point(const glm::vec3& world) const { return world * per_metre + middle; }
};

/// The lights and the glass of a scene at a time [s].
spheres::LightPathScene light_path_scene(const TankScene& scene, const spheres::Tank& tank, double time);

/// A tank's light by its scene; traces TankScene::photons paths through its glass.
TankIllumination illuminate(const TankContent& content, TankScene scene);

}  // namespace brume::scene
