#include "scene/tank_scene.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "scene/key_path.hpp"
#include "scene/options.hpp"

namespace brume::scene {

const char* view_name(TankView view) {
  return view == TankView::voxels ? "voxels" : "spheres";
}

const char* lighting_name(TankLighting lighting) {
  return lighting == TankLighting::exact ? "exact" : "maps";
}

const char* lens_points_name(LensPoints points) {
  return points == LensPoints::rejection ? "rejection" : "remap";
}

const char* arrangement_name(spheres::Arrangement arrangement) {
  constexpr const char* kNames[kArrangements]{"random", "largest_first", "noise", "coral"};
  return kNames[static_cast<std::uint32_t>(arrangement)];
}

const char* coloring_name(spheres::Coloring coloring) {
  constexpr const char* kNames[kColorings]{"random", "radius", "height", "noise"};
  return kNames[static_cast<std::uint32_t>(coloring)];
}

TankLight light_at(const TankLight& light, double time) {
  TankLight at = light;
  if (light.keys.empty()) return at;
  at.position_world =
      smooth_at(std::span(light.keys), time, [](const PlaceKey& key) { return key.position_world; });
  return at;
}

TankGlass glass_at(const TankGlass& glass, double time) {
  TankGlass at = glass;
  if (glass.keys.empty()) return at;
  const std::span keys(glass.keys);
  at.position_world = smooth_at(keys, time, [](const GlassKey& key) { return key.position_world; });
  // A path through radii may swing below the smallest.
  at.radii = glm::max(smooth_at(keys, time, [](const GlassKey& key) { return key.radii; }), 1e-4f);
  return at;
}

Camera camera_at(const TankScene& scene, const glm::vec3& tank_size, double time) {
  // Before the middle of the widest side, so that all of it is in view.
  Camera before;
  before.vertical_fov = static_cast<float>(40 * kRadiansOfDegree);
  const float reach = 0.5f * std::max(tank_size.y, tank_size.x * 0.5625f);
  const float distance = 1.1f * reach / std::tan(0.5f * before.vertical_fov) + 0.5f * tank_size.z;
  before.position_world = {0, 0, distance};
  before.target_world = {0, 0, 0};
  return camera_at(scene.camera, before, time);
}

}  // namespace brume::scene
