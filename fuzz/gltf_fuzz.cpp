#include "fuzz/scene_fuzz.hpp"
#include "scene/files/gltf.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace brume::scene;
  static const MemoryFiles files = [] {
    MemoryFiles result;
    result.add_text("data.bin", std::string(256, '\x3f'));
    return result;
  }();
  const auto scene = parse_gltf(std::as_bytes(std::span(data, size)), "a.gltf", files);
  if (scene) check_scene(*scene);
  return 0;
}
