// Makes glTF documents for tests.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string>

#include "scene/files/gltf.hpp"
#include "tests/scene/scene_test_tools.hpp"

namespace brume::scene {

/// A buffer to append values to, the binary part of a document.
struct Bytes {
  std::string data;
  template <typename T>
  Bytes& add(std::initializer_list<T> values) {
    for (const T value : values) data.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  std::size_t size() const { return data.size(); }
};

/// The positions of one triangle in the x-y plane.
inline Bytes triangle() {
  return Bytes().add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
}

inline Result<Scene> load_gltf(const std::string& text, const MemoryFiles& files) {
  return parse_gltf(std::as_bytes(std::span(text)), "a.gltf", files);
}

/// A document with one mesh of one primitive.
struct Document {
  std::string nodes = R"([{"mesh": 0}])";
  std::string primitive = R"({"attributes": {"POSITION": 0}})";
  std::string accessors = R"([{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}])";
  std::string views;  ///< Default: one over everything.
  std::string more;   ///< Additional members after a comma.
  std::string uri = "data.bin";
  Bytes binary = triangle();
  std::size_t promised = 0;  ///< byteLength, if it differs from the size of the binary part.

  std::string json() const {
    const std::string length = std::to_string(promised ? promised : binary.size());
    return R"({"asset": {"version": "2.0"}, "nodes": )" + nodes + R"(, "meshes": [{"primitives": [)" +
           primitive + R"(]}], "accessors": )" + accessors + R"(, "bufferViews": )" +
           (views.empty() ? R"([{"buffer": 0, "byteLength": )" + std::to_string(binary.size()) + "}]"
                          : views) +
           R"(, "buffers": [{"byteLength": )" + length + (uri.empty() ? "" : R"(, "uri": ")" + uri + "\"") +
           "}]" + more + "}";
  }
  Result<Scene> load() const {
    MemoryFiles files;
    files.add_text("data.bin", binary.data);
    return load_gltf(json(), files);
  }
  std::string error() const {
    const auto scene = load();
    if (scene) return "no error";
    EXPECT_EQ(scene.failure().message.find('\n'), std::string::npos);
    return scene.failure().message;
  }
};

#define EXPECT_HAS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

inline glm::vec3 world_corner(const Scene& scene, std::size_t object, std::size_t corner) {
  const Mesh& mesh = scene.meshes[scene.objects.at(object).mesh];
  return glm::vec3(scene.objects[object].world_from_mesh *
                   glm::vec4(mesh.vertices[mesh.indices.at(corner)].position, 1));
}

/// A GLB file.
inline std::string glb_of(std::string json, std::string binary) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  Bytes glb;
  const auto length = [](const std::string& text) { return static_cast<std::uint32_t>(text.size()); };
  glb.add<std::uint32_t>({0x46546c67u, 2u, 28u + length(json) + length(binary), length(json), 0x4e4f534au});
  glb.data += json;
  glb.add<std::uint32_t>({length(binary), 0x004e4942u});
  glb.data += binary;
  return glb.data;
}

/// Writes a file into the folder that BRUME_SEEDS names, if it is set. Seeds of the fuzzer, fuzz/corpus/gltf,
/// are made so.
inline void keep_as_seed(const std::string& name, const std::string& bytes) {
  const char* folder = std::getenv("BRUME_SEEDS");
  if (folder) std::ofstream(std::string(folder) + "/" + name, std::ios::binary) << bytes;
}

}  // namespace brume::scene
