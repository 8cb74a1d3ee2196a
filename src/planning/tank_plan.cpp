#include "planning/tank_plan.hpp"

#include <cmath>

#include "planning/device_camera.hpp"

namespace brume::planning {
namespace {

/// From metres around the tank's middle to voxels from its low corner.
struct ToVoxels {
  float per_metre;
  glm::vec3 middle;
  explicit ToVoxels(const spheres::Tank& tank)
      : per_metre(1 / tank.voxel), middle(0.5f * glm::vec3(tank.size)) {}
  glm::vec3 point(const glm::vec3& world) const { return world * per_metre + middle; }
};

shared::TankCamera tank_camera(const shared::Camera& pinhole, const scene::Camera& camera,
                               const ToVoxels& voxels) {
  shared::TankCamera lens{};
  lens.eye = voxels.point(pinhole.eye_world);
  lens.aperture = camera.lens.aperture * voxels.per_metre;
  lens.forward = pinhole.forward;
  lens.focus = focus_distance(camera) * voxels.per_metre;
  lens.right = pinhole.right;
  lens.blades = camera.lens.blades;
  lens.up = pinhole.up;
  return lens;
}

/// All of the plan but the camera.
TankPlan plan_tank_alone(const scene::TankScene& scene, const spheres::Tank& tank, double time,
                         glm::uvec2 size_px) {
  const ToVoxels voxels(tank);
  TankPlan plan;
  shared::TankConstants& constants = plan.constants;

  // The medium and the glass, in voxels.
  constants.air = {scene.sky.zenith, scene.sky.horizon, scene.sky.ambient, scene.fog.color,
                   scene.fog.extinction / voxels.per_metre};
  if (scene.glass) {
    const scene::TankGlass glass = scene::glass_at(*scene.glass, time);
    constants.glass = {voxels.point(glass.position_world), glass.index, glass.radii * voxels.per_metre};
  } else {
    constants.glass = {glm::vec3(0), 0, glm::vec3(1)};
  }
  constants.size = glm::ivec3(tank.size);
  constants.bricks = (constants.size + (shared::kSphereBrick - 1)) / shared::kSphereBrick;
  constants.size_px = size_px;
  constants.bounces = scene.bounces;

  for (const scene::TankLight& source : scene.lights) {
    const scene::TankLight light = scene::light_at(source, time);
    plan.lights.push_back({voxels.point(light.position_world), light.radius * voxels.per_metre,
                           light.color * (light.intensity * voxels.per_metre * voxels.per_metre)});
  }
  constants.light_count = static_cast<glm::uint>(plan.lights.size());
  return plan;
}

}  // namespace

TankPlan plan_tank(const scene::TankScene& scene, const spheres::Tank& tank, double time, glm::uvec2 size_px,
                   const std::optional<scene::Camera>& camera) {
  TankPlan plan = plan_tank_alone(scene, tank, time, size_px);
  const scene::Camera from = camera ? *camera : scene::camera_at(scene, size_of(tank), time);
  plan.constants.camera = tank_camera(device_camera(from, size_px), from, ToVoxels(tank));
  plan.constants.camera.lens_points =
      scene.lens_points == scene::LensPoints::rejection ? shared::kLensRejection : shared::kLensRemap;
  return plan;
}

TankPlan plan_tank_in_frame(const scene::TankScene& scene, const spheres::Tank& tank,
                            const TankPlacement& placement, const scene::Camera& camera, glm::uvec2 size_px) {
  TankPlan plan = plan_tank_alone(scene, tank, 0, size_px);
  shared::Camera pinhole = device_camera(camera, size_px);
  const glm::mat3 tank_from_world = glm::transpose(placement.axes);
  pinhole.eye_world = tank_from_world * (pinhole.eye_world - placement.position_world) / placement.scale;
  pinhole.forward = tank_from_world * pinhole.forward;
  pinhole.right = tank_from_world * pinhole.right;
  pinhole.up = tank_from_world * pinhole.up;
  plan.constants.camera = tank_camera(pinhole, camera, ToVoxels(tank));
  plan.constants.surface_near = pinhole.near_z / (placement.scale * tank.voxel);
  return plan;
}

spheres::LightPathScene light_path_scene(const TankPlan& plan) {
  spheres::LightPathScene scene;
  scene.glass = plan.constants.glass;
  for (const shared::TankLight& light : plan.lights)
    scene.lights.push_back({light.position, light.radius, light.intensity});
  return scene;
}

TankDisplay plan_tank_display(const scene::TankScene& scene, glm::uvec2 size_px) {
  TankDisplay display;
  shared::FrameConstants& frame = display.frame;
  frame.size_px = size_px;
  frame.exposure = std::exp2(scene.exposure);
  frame.tone = static_cast<glm::uint>(scene.tone);
  display.dither = scene.dither;
  return display;
}

}  // namespace brume::planning
