// Converts the materials of a glTF document, each once. Throws brume::Error, which parse_gltf converts to its
// Result.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "scene/files/gltf_document.hpp"
#include "scene/files/scene_builder.hpp"

namespace brume::scene {

/// The fraction of light that passes a material, by KHR_materials_transmission.
double transmission_of(const tinygltf::Material& material);

class GltfMaterials {
 public:
  GltfMaterials(const GltfDocument& document, SceneBuilder& builder);

  struct Converted {
    std::uint32_t index = kNone;                  ///< Into Scene::materials.
    int uv_set = 0;                               ///< The TEXCOORD set that its images use.
    glm::mat3x2 image_from_uv{1, 0, 0, 1, 0, 0};  ///< Multiplies (u, v, 1).
  };
  /// The material with the document's index, or the default one for -1.
  Converted material(int index);
  /// What a mesh of a material stops; `index`: Converted::index.
  Role role(std::uint32_t index, const Mesh& mesh) const;
  /// The role in `extras`, which may be any value; warns of the first one of the file that is no role.
  std::optional<Role> role_of_extras(const tinygltf::Value& extras, const std::string& place);

 private:
  Material convert(const tinygltf::Material& source, const std::string& place);
  Converted texture_coordinates(const tinygltf::Material& source, const std::string& place) const;
  std::uint32_t image_of_texture(int texture, ImageUse use);
  Wraps wraps_of_texture(const tinygltf::Texture& texture) const;
  glm::vec3 mean_color(std::uint32_t image) const;

  const GltfDocument& document_;
  SceneBuilder& builder_;
  std::map<int, Converted> materials_;
  struct AlphaSource {
    std::uint32_t image = kNone;
    double factor = 1, cutoff = 0.5;
  };
  std::map<std::uint32_t, AlphaSource> alphas_;  // by material, of those that are not opaque
  std::map<std::pair<int, Wraps>, std::uint32_t> images_;
  bool warned_of_role_ = false;
};

}  // namespace brume::scene
