// What shaders need of a tank's scene at a time.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "planning/frame_input.hpp"
#include "scene/tank_scene.hpp"
#include "shared/frame.h"
#include "shared/tank.h"
#include "spheres/light_paths.hpp"
#include "spheres/tank.hpp"

namespace brume::planning {

/// Everything that samples of a tank depend on.
struct TankPlan {
  shared::TankConstants constants{};
  std::vector<shared::TankLight> lights;
  scene::TankView view = scene::TankView::spheres;
  scene::TankLighting lighting = scene::TankLighting::maps;
  std::uint32_t photons = 0;  ///< Light paths of a picture of the tank alone.
};
/// Whether samples of the two may be added up.
bool same_samples(const TankPlan& a, const TankPlan& b);

/// [m]
inline glm::vec3 size_of(const spheres::Tank& tank) {
  return tank.voxel * glm::vec3(tank.size);
}

/// The camera of the scene, or another one.
TankPlan plan_tank(const scene::TankScene& scene, const spheres::Tank& tank, double time, glm::uvec2 size_px,
                   const std::optional<scene::Camera>& camera = {});

/// The tank in a frame of this camera, over the frame's surfaces (passes::TankTargets::surfaces). Lights and
/// glass are where they are at the start. Where the frame is one of several samples of a picture, its rays
/// are the frame's own; else they lie anywhere in their pixels, whatever its point of the pixel. The view is
/// the caller's choice.
TankPlan plan_tank_in_frame(const scene::TankScene& scene, const spheres::Tank& tank,
                            const TankPlacement& placement, const scene::Camera& camera,
                            const ViewSample& sample, glm::uvec2 size_px);

/// Where light through the glass is traced from.
spheres::LightPathScene light_path_scene(const TankPlan& plan);
/// How many light paths a picture of the tank alone has use for: voxels show no light through the glass.
std::uint32_t light_path_count(const TankPlan& plan);

/// How a picture is shown.
struct TankDisplay {
  shared::FrameConstants frame{};  ///< Exposure, tone curve and size; the rest is of no use.
  float dither = 1;                ///< As passes::DisplayPass::record.
};
TankDisplay plan_tank_display(const scene::TankScene& scene, glm::uvec2 size_px);

}  // namespace brume::planning
