// Where the lights, the glass and the camera of a tank are at a time.
#include <algorithm>
#include <cmath>
#include <span>

#include "scene/key_path.hpp"
#include "scene/options.hpp"
#include "scene/tank_scene.hpp"

namespace brume::scene {

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
