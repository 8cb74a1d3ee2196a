#include "scene/files/load.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/scene/scene_test_tools.hpp"

namespace brume::scene {
namespace {

TEST(Load, ASceneWithoutATriangleIsRefusedUnlessItMayBeEmpty) {
  const auto folder = std::filesystem::temp_directory_path() / ("brume_empty" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const std::pair<const char*, const char*> files[] = {
      {"Scene.txt", "LIGHT_SOURCE\t1 2 3\t1 1 1\t5\n"},
      {"a.gltf",
       R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"camera": 0}], "cameras":
                 [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}]})"}};
  for (const auto& [name, text] : files) {
    std::ofstream(folder / name) << text;
    EXPECT_EQ(load_scene(folder / name).failure().message,
              (folder / name).string() + ": the scene has no triangle; add at least one object with a mesh");
    const auto scene = load_scene(folder / name, true);
    ASSERT_TRUE(scene) << scene.failure().message;
    EXPECT_TRUE(scene->objects.empty());
    EXPECT_EQ(scene->lights.size() + (scene->camera ? 1 : 0), 1u);
  }
  std::filesystem::remove_all(folder);
}

TEST(Load, SuffixesMayBeInCapitals) {
  const auto folder = std::filesystem::temp_directory_path() / ("brume_load" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const auto write = [&](const char* name, const std::string& text) {
    std::ofstream(folder / name) << text;
    return folder / name;
  };
  EXPECT_TRUE(load_scene(write("A.OBJ", kCubeObj)));
  const auto gltf = load_scene(write("B.GlTF", "{\"asset\": {\"version\": \"1.0\"}}"));
  EXPECT_NE(gltf.failure().message.find("is glTF 1.0"), std::string::npos);
  const auto other = load_scene(write("C.fbx", ""));
  EXPECT_NE(other.failure().message.find("expected .txt, .gltf, .glb or .obj, or .toml for a timeline"),
            std::string::npos);
  std::filesystem::remove_all(folder);
  EXPECT_EQ(lower_extension("x/D.TOML"), ".toml");
}

}  // namespace
}  // namespace brume::scene
