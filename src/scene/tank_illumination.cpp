#include "scene/tank_illumination.hpp"

namespace brume::scene {

spheres::LightPathScene light_path_scene(const TankScene& scene, const spheres::Tank& tank, double time) {
  const TankVoxels voxels(tank);
  spheres::LightPathScene found;
  if (scene.glass) {
    const TankGlass glass = glass_at(*scene.glass, time);
    found.glass = {voxels.point(glass.position_world), glass.index, glass.radii * voxels.per_metre};
  }
  for (const TankLight& source : scene.lights) {
    const TankLight light = light_at(source, time);
    found.lights.push_back({voxels.point(light.position_world), light.radius * voxels.per_metre,
                            light.color * (light.intensity * voxels.per_metre * voxels.per_metre)});
  }
  return found;
}

TankIllumination illuminate(const TankContent& content, TankScene scene) {
  TankIllumination light;
  if (scene.glass && scene.photons > 0) {
    spheres::LightPathOptions options;
    options.count = scene.photons;
    light.paths = spheres::trace_light_paths(content.tank, content.bricks,
                                             light_path_scene(scene, content.tank, 0), options);
  }
  light.scene = std::move(scene);
  return light;
}

}  // namespace brume::scene
