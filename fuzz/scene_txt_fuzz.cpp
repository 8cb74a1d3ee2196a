#include "fuzz/scene_fuzz.hpp"
#include "scene/files/scene_txt.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace brume::scene;
  static const MemoryFiles files = [] {
    MemoryFiles result;
    result.add_text("Meshes/A.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    result.add_text("Meshes/Grenade.obj", "v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n");
    result.add_text("Textures/A_diffuse.png", "not a picture");
    return result;
  }();
  const auto scene = parse_scene_txt(as_text(data, size), "Scene.txt", files);
  if (scene) check_scene(*scene);
  return 0;
}
