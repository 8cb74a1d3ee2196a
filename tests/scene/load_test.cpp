#include "scene/files/load.hpp"

#include <filesystem>

#include "tests/scene/scene_test_tools.hpp"

namespace brume::scene {
namespace {

TEST(Load, ASceneWithoutATriangleIsRefusedUnlessItMayBeEmpty) {
  const cli::WorkFolder folder;
  const std::pair<const char*, const char*> files[] = {
      {"Scene.txt", "LIGHT_SOURCE\t1 2 3\t1 1 1\t5\n"},
      {"a.gltf",
       R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"camera": 0}], "cameras":
                 [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}]})"}};
  for (const auto& [name, text] : files) {
    const auto path = folder.path() / folder.write(name, text);
    EXPECT_EQ(load_scene(path).failure().message,
              path.string() + ": the scene has no triangle; add at least one object with a mesh");
    const auto scene = load_scene(path, true).value_or_throw();
    EXPECT_TRUE(scene.objects.empty());
    EXPECT_EQ(scene.lights.size() + (scene.camera ? 1 : 0), 1u);
  }
}

TEST(Load, SuffixesMayBeInCapitals) {
  const cli::WorkFolder folder;
  const auto write = [&](const char* name, const std::string& text) {
    return folder.path() / folder.write(name, text);
  };
  EXPECT_TRUE(load_scene(write("A.OBJ", kCubeObj)));
  const auto gltf = load_scene(write("B.GlTF", "{\"asset\": {\"version\": \"1.0\"}}"));
  EXPECT_NE(gltf.failure().message.find("is glTF 1.0"), std::string::npos);
  const auto other = load_scene(write("C.fbx", ""));
  EXPECT_NE(other.failure().message.find("expected .txt, .gltf, .glb or .obj, or .toml for a timeline"),
            std::string::npos);
  EXPECT_EQ(lower_extension("x/D.TOML"), ".toml");
}

}  // namespace
}  // namespace brume::scene
