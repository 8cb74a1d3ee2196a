// Converts the meshes of a glTF document, each once. Throws brume::Error, which parse_gltf converts to its
// Result.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "scene/files/gltf_materials.hpp"
#include "scene/files/gltf_nodes.hpp"

namespace brume::scene {

class GltfMeshes {
 public:
  GltfMeshes(const GltfDocument& document, GltfMaterials& materials, SceneBuilder& builder);

  struct Part {
    std::uint32_t mesh = kNone, material = kNone;
    Role role = Role::wall;  ///< By its material.
  };
  /// The triangle primitives of meshes[index], with so much of its morph targets, in their order; in world
  /// space if they have a skin, else -1.
  const std::vector<Part>& parts(int index, const std::vector<double>& weights, int skin);

 private:
  Mesh convert(const tinygltf::Primitive& primitive, const GltfMaterials::Converted& material,
               const std::vector<double>& weights, int skin, const std::string& place);

  const GltfDocument& document_;
  GltfMaterials& materials_;
  SceneBuilder& builder_;
  GltfSkins skins_;
  std::map<std::tuple<int, int, std::vector<double>>, std::vector<Part>> parts_;
};

}  // namespace brume::scene
