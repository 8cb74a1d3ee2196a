// Transforms of a glTF document's nodes, and the meshes that skins deform by them. Throws brume::Error, which
// parse_gltf converts to its Result.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "scene/files/gltf_document.hpp"
#include "scene/files/gltf_primitive.hpp"
#include "scene/scene.hpp"

namespace brume::scene {

/// Translation * rotation * scale, of three, four and three numbers; an empty list leaves its part out.
glm::dmat4 composed(std::span<const double> translation, std::span<const double> rotation,
                    std::span<const double> scale);

/// From the node's space to its parent's.
glm::dmat4 local_matrix(const tinygltf::Node& node);

/// Poses of skins: where their joints stand in the file, without animations.
class GltfSkins {
 public:
  explicit GltfSkins(const GltfDocument& document) : document_(document) {}

  /// world_from_mesh of each joint of skins[index]: its node's transform times its inverse bind matrix.
  const std::vector<glm::dmat4>& pose(int index);

 private:
  glm::dmat4 world_from_node(int node);
  std::vector<int> parents() const;

  const GltfDocument& document_;
  std::vector<int> parents_;
  std::map<int, glm::dmat4> worlds_;
  std::map<int, std::vector<glm::dmat4>> poses_;
};

/// Moves a primitive's vertices to world space: each by the mean of its joints' matrices, weighted by
/// WEIGHTS_0, WEIGHTS_1 and so on. A vertex without weights follows the first joint.
void apply_skin(const GltfDocument& document, const GltfPrimitive& primitive,
                std::span<const glm::dmat4> world_from_joint, const std::string& place, Mesh& mesh);

}  // namespace brume::scene
