#include <cstdlib>
#include <filesystem>

#include "scene/files/load.hpp"
#include "tests/render/fairness.hpp"

namespace brume::render {
namespace {

/// One grown smoke in the yard, and the sign in place of the grenade.
scenario::Scenario motel(const std::filesystem::path& path) {
  scene::Scene scene = scene::load_scene(path).value_or_throw();
  scene::Mesh sign;
  add_box(sign, glm::vec3(-0.5f), glm::vec3(0.5f));
  scene.meshes.push_back(sign);
  scene.materials.push_back({});
  scene.materials.back().emission = glm::vec3(4);
  scene.grenade = {"sign", static_cast<std::uint32_t>(scene.meshes.size() - 1),
                   static_cast<std::uint32_t>(scene.materials.size() - 1), glm::mat4(1), Role::ghost};
  if (!scene.camera) scene.camera = scene::Camera{};
  scene::Timeline timeline;
  timeline.smokes = {{0, {0, 2, -6}, {0, 1.2f, -6}}};
  timeline.smoke.extinction = 1.5f;
  // In voxels of half a metre reduced pictures with detail show up to 4.8 steps more (docs/how/smoke.md,
  // "Limits").
  timeline.smoke.detail = 0;
  return scenario_of(std::move(scene), std::move(timeline), {{120, 20, 120}, 0.5f, {-30, 0, -30}});
}

TEST_F(FairnessTest, TwoHundredPairsInTheMotel) {
  const char* folder = std::getenv("BRUME_MOTEL");
  const std::filesystem::path path =
      std::filesystem::path(folder ? folder : BRUME_SOURCE_DIR "/../shared/data/motel") / "Scene.txt";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there; set BRUME_MOTEL to its folder";
  const scenario::Scenario scenario = motel(path);
  expect_fair(scenario, random_pairs(scenario, {-9, 0.3f, -15}, {9, 3.5f, 3}, 15, 200));
}

}  // namespace
}  // namespace brume::render
