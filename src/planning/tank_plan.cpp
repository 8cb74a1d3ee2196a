#include "planning/tank_plan.hpp"

#include <algorithm>
#include <cmath>

#include "core/same_bytes.hpp"
#include "planning/device_camera.hpp"

namespace brume::planning {
namespace {

shared::TankCamera tank_camera(const shared::Camera& pinhole, const scene::Camera& camera,
                               const scene::TankVoxels& voxels) {
  shared::TankCamera lens{};
  lens.eye = voxels.point(pinhole.eye_world);
  lens.aperture = camera.lens.aperture * voxels.per_metre;
  lens.forward = pinhole.forward;
  lens.focus = focus_distance(camera) * voxels.per_metre;
  lens.right = pinhole.right;
  lens.blades = camera.lens.blades;
  lens.up = pinhole.up;
  lens.shift = pinhole.shift;
  return lens;
}

/// All of the plan but the camera.
TankPlan plan_tank_alone(const scene::TankScene& scene, const spheres::Tank& tank, double time,
                         glm::uvec2 size_px) {
  const scene::TankVoxels voxels(tank);
  TankPlan plan;
  shared::TankConstants& constants = plan.constants;

  // The medium and the glass, in voxels.
  constants.air.zenith = scene.sky.zenith;
  constants.air.horizon = scene.sky.horizon;
  constants.air.ambient = scene.sky.ambient;
  constants.air.fog_color = scene.fog.color;
  constants.air.fog_extinction = scene.fog.extinction / voxels.per_metre;
  const spheres::LightPathScene light = scene::light_path_scene(scene, tank, time);
  constants.glass = light.glass;
  constants.size = glm::ivec3(tank.size);
  constants.bricks = (constants.size + (shared::kSphereBrick - 1)) / shared::kSphereBrick;
  constants.size_px = size_px;
  constants.bounces = scene.bounces;

  for (const spheres::LightBall& ball : light.lights)
    plan.lights.push_back({ball.position, ball.radius, ball.intensity});
  constants.light_count = static_cast<glm::uint>(plan.lights.size());
  return plan;
}

}  // namespace

bool same_samples(const TankPlan& a, const TankPlan& b) {
  return a.view == b.view && a.lighting == b.lighting && a.photons == b.photons &&
         same_bytes(a.constants, b.constants) &&
         std::ranges::equal(a.lights, b.lights, same_bytes<shared::TankLight>);
}

TankPlan plan_tank(const scene::TankScene& scene, const spheres::Tank& tank, double time, glm::uvec2 size_px,
                   const std::optional<scene::Camera>& camera) {
  TankPlan plan = plan_tank_alone(scene, tank, time, size_px);
  plan.view = scene.view;
  plan.lighting = scene.lighting;
  plan.photons = scene.photons;
  const scene::Camera from = camera ? *camera : scene::camera_at(scene, size_of(tank), time);
  plan.constants.camera = tank_camera(device_camera(from, size_px), from, scene::TankVoxels(tank));
  plan.constants.camera.lens_points =
      scene.lens_points == scene::LensPoints::rejection ? shared::kLensRejection : shared::kLensRemap;
  return plan;
}

TankPlan plan_tank_in_frame(const scene::TankScene& scene, const spheres::Tank& tank,
                            const TankPlacement& placement, const scene::Camera& camera,
                            const ViewSample& sample, glm::uvec2 size_px) {
  TankPlan plan = plan_tank_alone(scene, tank, 0, size_px);
  plan.constants.in_middle = sample.count > 1 ? 1 : 0;
  shared::Camera pinhole = device_camera(camera, size_px, sample.count > 1 ? sample : ViewSample());
  const glm::mat3 tank_from_world = glm::transpose(placement.axes);
  pinhole.eye_world = tank_from_world * (pinhole.eye_world - placement.position_world) / placement.scale;
  pinhole.forward = tank_from_world * pinhole.forward;
  pinhole.right = tank_from_world * pinhole.right;
  pinhole.up = tank_from_world * pinhole.up;
  plan.constants.camera = tank_camera(pinhole, camera, scene::TankVoxels(tank));
  plan.constants.camera.aperture = 0;  // a frame is what a pinhole sees
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

std::uint32_t light_path_count(const TankPlan& plan) {
  const bool has_paths =
      plan.view == scene::TankView::spheres && plan.constants.glass.index > 0 && !plan.lights.empty();
  return has_paths ? plan.photons : 0;
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
