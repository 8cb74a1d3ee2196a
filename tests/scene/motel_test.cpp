// Tests with the motel scene, if it is available.
#include <chrono>
#include <cstdlib>
#include <filesystem>

#include "scene/files/load.hpp"
#include "tests/scene/scene_test_tools.hpp"

namespace brume::scene {
namespace {

std::filesystem::path motel_folder() {
  const char* const chosen = std::getenv("BRUME_MOTEL");
  return chosen != nullptr ? chosen : BRUME_SOURCE_DIR "/../shared/data/motel";
}

TEST(Motel, LoadsCompletely) {
  const std::filesystem::path path = motel_folder() / "Scene.txt";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "the motel is not here; set BRUME_MOTEL to its folder";
  const LogLines warnings;
  const auto start = std::chrono::steady_clock::now();
  const auto scene = load_scene(path);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  ASSERT_TRUE(scene) << scene.failure().message;
  expect_sound(*scene);

  EXPECT_TRUE(warnings.lines.empty()) << warnings.lines.front();
  EXPECT_EQ(scene->objects.size(), 156u) << "157 lines, one of them the grenade";
  EXPECT_EQ(scene->grenade->name, "Grenade");
  EXPECT_EQ(scene->lights.size(), 51u);
  std::size_t triangles = 0, ignored = 0;
  bool case_differs = false;
  for (const Object& object : scene->objects) {
    triangles += scene->meshes[object.mesh].indices.size() / 3;
    ignored += object.role == Role::ghost ? 1 : 0;
    case_differs =
        case_differs || (object.name == "Grossewand" && !scene->meshes[object.mesh].indices.empty());
  }
  EXPECT_TRUE(case_differs) << "Grossewand is GrosseWand.obj on disk";
  EXPECT_NEAR(static_cast<double>(triangles), 101000, 0.02 * 101000);
  EXPECT_EQ(ignored, 12u);
  RecordProperty("seconds", std::to_string(seconds.count()));
}

}  // namespace
}  // namespace brume::scene
