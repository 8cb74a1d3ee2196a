// The attributes and corners of one primitive, from its accessors or from its Draco mesh.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/files/gltf_document.hpp"
#include "scene/files/gltf_draco.hpp"

namespace brume::scene {

class GltfPrimitive {
 public:
  /// Decodes a compressed primitive. Throws brume::Error with `place`, as all members do.
  GltfPrimitive(const GltfDocument& document, const tinygltf::Primitive& primitive, std::string place);

  /// Numbers per vertex, 0 if the primitive lacks the attribute.
  int components(const std::string& attribute) const;
  /// Finite numbers, `components` per vertex; empty if the primitive lacks the attribute.
  std::vector<float> floats(const std::string& attribute, int components) const;
  /// Three corners a triangle, each below `vertices`.
  std::vector<std::uint32_t> triangles(std::size_t vertices) const;

 private:
  void decode(const tinygltf::Value& extension);
  const PackedElements* compressed(const std::string& attribute) const;

  const GltfDocument& document_;
  const tinygltf::Primitive& primitive_;
  std::string place_;
  std::optional<DracoMesh> draco_;
  std::map<std::string, std::uint32_t> draco_ids_;
};

}  // namespace brume::scene
