#include "scene/load.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/scene/scene_test_tools.hpp"

namespace brume::scene {
namespace {

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
