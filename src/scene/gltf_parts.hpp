// The materials and meshes of a glTF document, each converted once. Throws brume::Error; parse_gltf turns
// that into its Result.
#pragma once

#include <map>
#include <vector>

#include "scene/gltf_buffers.hpp"
#include "scene/gltf_json.hpp"
#include "scene/scene_builder.hpp"

namespace brume::scene {

class GltfMaterials {
 public:
  GltfMaterials(GltfValue document, GltfBuffers& buffers, SceneBuilder& builder, const SceneFiles& files);

  struct Converted {
    std::uint32_t index = kNone;  ///< Into Scene::materials.
    std::uint64_t uv_set = 0;     ///< The TEXCOORD that its images use.
  };
  /// The material that a primitive names, or the default one.
  Converted of_primitive(const GltfValue& primitive);

 private:
  Material convert(const GltfValue& description, std::uint64_t& uv_set);
  std::uint32_t image_of_texture(const GltfValue& reference, std::uint64_t& uv_set);
  glm::vec3 mean_color(std::uint32_t image) const;

  GltfValue document_;
  GltfBuffers& buffers_;
  SceneBuilder& builder_;
  const SceneFiles& files_;
  std::map<std::uint64_t, Converted> materials_;
  std::map<std::uint64_t, std::uint32_t> images_;
  std::uint32_t default_ = kNone;
};

class GltfMeshes {
 public:
  GltfMeshes(GltfValue document, GltfBuffers& buffers, GltfMaterials& materials, SceneBuilder& builder);

  struct Part {
    std::uint32_t mesh = kNone, material = kNone;
  };
  /// The primitives of meshes[index] that are triangles.
  const std::vector<Part>& parts(std::uint64_t index, const GltfValue& asker);

 private:
  Mesh convert(const GltfValue& primitive, std::uint64_t uv_set);

  GltfValue document_;
  GltfBuffers& buffers_;
  GltfMaterials& materials_;
  SceneBuilder& builder_;
  std::map<std::uint64_t, std::vector<Part>> parts_;
};

}  // namespace brume::scene
