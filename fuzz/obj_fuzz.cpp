#include "fuzz/scene_fuzz.hpp"
#include "scene/files/obj.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace brume::scene;
  // The bytes are both the mesh and its material file: each reader ignores the other's statements.
  MemoryFiles files;
  files.add_text("m.mtl", std::string(as_text(data, size)));
  const auto scene = parse_obj_scene(as_text(data, size), "a.obj", files);
  if (scene) check_scene(*scene);
  return 0;
}
