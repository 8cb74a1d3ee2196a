#include "scenario/tank.hpp"

#include "spheres/file.hpp"
#include "spheres/pack.hpp"

namespace brume::scenario {

Result<spheres::Tank> make_tank(const scene::TankScene& scene, const std::function<bool()>& stopped) {
  if (!scene.file.empty()) return spheres::load_tank(scene.file);
  return spheres::pack(scene.pack, stopped);
}

bool is_tank_input(const std::filesystem::path& path) {
  return spheres::is_tank_file(path) || scene::is_tank_scene(path);
}

Result<TankScenario> load_tank_scenario(const std::filesystem::path& path,
                                        const std::function<bool()>& stopped) {
  scene::TankScene scene;
  if (spheres::is_tank_file(path)) {
    scene = scene::scene_of_tank_file(path);
  } else {
    auto loaded = scene::load_tank_scene(path);
    if (!loaded) return loaded.failure();
    scene = std::move(*loaded);
  }
  auto tank = make_tank(scene, stopped);
  if (!tank) return tank.failure();
  return TankScenario{std::move(scene), std::move(*tank)};
}

std::vector<std::filesystem::path> files_of(const scene::TankScene& scene) {
  if (scene.file.empty()) return {};
  return {scene.file};
}

}  // namespace brume::scenario
