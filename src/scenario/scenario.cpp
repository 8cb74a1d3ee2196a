#include "scenario/scenario.hpp"

#include <cmath>

#include "scene/load.hpp"
#include "scene/stand_ins.hpp"
#include "voxel/voxelize.hpp"

namespace brume::scenario {
namespace {

Result<voxel::GridLayout> grid_layout(const scene::Timeline& timeline, const scene::Scene& scene) {
  // The margin holds a whole smoke in open air: a ball of its voxels with its soft rim.
  const auto& grid = timeline.grid;
  const int margin =
      2 + static_cast<int>(std::cbrt(static_cast<float>(timeline.smoke.voxels) * 0.75f / 3.14159f) * 1.2f);
  const Box<float> bounds = scene::world_bounds(scene);
  auto layout = voxel::layout_around(bounds.low, bounds.high, grid.voxel, margin);
  if (!layout && !(grid.size && grid.origin_world)) return layout;
  voxel::GridLayout chosen = layout ? *layout : voxel::GridLayout{glm::ivec3(1), grid.voxel, glm::vec3(0)};
  if (grid.size) chosen.size = *grid.size;
  if (grid.origin_world) chosen.origin_world = *grid.origin_world;
  return chosen;
}

/// Adds what a scenario needs to its timeline and its scene, which is loaded.
Result<Scenario> complete_scenario(scene::Timeline timeline, Result<scene::Scene> scene,
                                   const std::filesystem::path& cache_folder) {
  if (auto checked = scene::check_doors(timeline, *scene); !checked) return checked.failure();

  // A scene without any light gets a sun.
  if (scene->lights.empty()) {
    scene::Light sun;
    sun.kind = scene::LightKind::directional;
    sun.direction_world = glm::normalize(glm::vec3(-0.5f, -0.75f, -0.4f));
    sun.intensity = {2.6f, 2.4f, 2.1f};
    scene->lights.push_back(sun);
  }
  scene::add_built_in_grenade(*scene);
  const auto layout = grid_layout(timeline, *scene);
  if (!layout) return layout.failure();
  std::filesystem::path cache;
  if (!cache_folder.empty()) cache = cache_folder / timeline.scene.filename().replace_extension(".vxl");
  auto voxels = load_or_voxelize(*scene, *layout, cache);
  if (!voxels) return voxels.failure();

  // Camera and masks.
  const scene::Camera camera = scene->camera ? *scene->camera : scene::default_camera(*scene);
  auto masks = load_masks(timeline);
  if (!masks) return masks.failure();
  return Scenario{std::move(timeline), std::move(*scene),       camera,
                  std::move(*voxels),  std::move(masks->atlas), std::move(masks->of_shots)};
}

}  // namespace

Result<Scenario> load_scenario(const std::filesystem::path& input,
                               const std::filesystem::path& cache_folder) {
  if (scene::lower_extension(input) == ".toml") {
    auto timeline = scene::load_timeline(input);
    if (!timeline) return timeline.failure();
    return make_scenario(std::move(*timeline), cache_folder);
  }
  auto scene = scene::load_scene(input);
  if (!scene) return scene.failure();
  scene::Timeline timeline = scene::timeline_for_scene(input, *scene);
  return complete_scenario(std::move(timeline), std::move(scene), cache_folder);
}

Result<Scenario> make_scenario(scene::Timeline timeline, const std::filesystem::path& cache_folder) {
  auto scene = scene::load_scene(timeline.scene);
  if (!scene) return scene.failure();
  return complete_scenario(std::move(timeline), std::move(scene), cache_folder);
}

}  // namespace brume::scenario
