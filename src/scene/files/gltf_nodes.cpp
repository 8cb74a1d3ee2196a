#include "scene/files/gltf_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "scene/files/mesh_tools.hpp"
#include "scene/files/scene_builder.hpp"

namespace brume::scene {
namespace {

/// The matrices of a primitive's vertices.
class Blend {
 public:
  Blend(const GltfDocument& document, const GltfPrimitive& primitive, std::size_t joints,
        std::size_t vertices, const std::string& place) {
    for (int set = 0; set == 0 || primitive.components("JOINTS_" + std::to_string(set)) > 0; ++set) {
      const std::string number = std::to_string(set);
      Set read{primitive.floats("JOINTS_" + number, 4), primitive.floats("WEIGHTS_" + number, 4)};
      if (read.joints.size() != 4 * vertices || read.weights.size() != 4 * vertices)
        document.fail(place + ".attributes",
                      "expected JOINTS_" + number + " and WEIGHTS_" + number +
                          " with as many elements as there are positions, because its node has a skin");
      for (const float joint : read.joints)
        if (!(joint >= 0 && joint < static_cast<float>(joints)))
          document.fail(place + ".attributes.JOINTS_" + number,
                        "names a joint beyond the " + std::to_string(joints) + " of its skin");
      sets_.push_back(std::move(read));
    }
  }

  glm::dmat4 matrix(std::size_t vertex, std::span<const glm::dmat4> world_from_joint) const {
    glm::dmat4 sum(0);
    double total = 0;
    for (const Set& set : sets_)
      for (std::size_t i = 4 * vertex; i < 4 * vertex + 4; ++i) {
        const double weight = std::max(0.0, double{set.weights[i]});
        if (weight == 0) continue;
        sum += weight * world_from_joint[static_cast<std::size_t>(set.joints[i])];
        total += weight;
      }
    return total > 0 ? sum / total : world_from_joint.front();
  }

 private:
  struct Set {
    std::vector<float> joints, weights;
  };
  std::vector<Set> sets_;
};

/// Unit length; a vector that a flat matrix leaves without any keeps its direction in the mesh.
glm::vec3 turned(const glm::dmat3& matrix, glm::vec3 direction) {
  const glm::dvec3 result = matrix * glm::dvec3(direction);
  const double length = glm::length(result);
  return length > 1e-30 && std::isfinite(length) ? glm::vec3(result / length) : direction;
}

/// The inverse transpose times the determinant, which flat matrices have too.
glm::dmat3 cofactors(const glm::dmat3& m) {
  return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

}  // namespace

glm::dmat4 composed(std::span<const double> translation, std::span<const double> rotation,
                    std::span<const double> scale) {
  glm::dmat4 result(1);
  if (translation.size() == 3) result = glm::translate(result, glm::make_vec3(translation.data()));
  if (rotation.size() == 4) {
    const glm::dquat quaternion(rotation[3], rotation[0], rotation[1], rotation[2]);
    if (glm::length(quaternion) > 1e-12) result = result * glm::mat4_cast(glm::normalize(quaternion));
  }
  if (scale.size() == 3) result = glm::scale(result, glm::make_vec3(scale.data()));
  return result;
}

glm::dmat4 local_matrix(const tinygltf::Node& node) {
  if (node.matrix.size() == 16) return glm::make_mat4(node.matrix.data());
  return composed(node.translation, node.rotation, node.scale);
}

std::vector<int> GltfSkins::parents() const {
  const std::vector<tinygltf::Node>& nodes = document_.model().nodes;
  std::vector<int> parents(nodes.size(), -1);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (const int child : nodes[i].children) parents[static_cast<std::size_t>(child)] = static_cast<int>(i);
  return parents;
}

glm::dmat4 GltfSkins::world_from_node(int node) {
  if (parents_.empty()) parents_ = parents();
  // Up to a known ancestor or the root, then down again: files control the depth.
  std::vector<int> path;
  while (node >= 0 && !worlds_.contains(node)) {
    path.push_back(node);
    node = parents_[static_cast<std::size_t>(node)];
    if (path.size() > parents_.size())
      document_.fail(document_.place("nodes", static_cast<std::size_t>(node)), "is an ancestor of itself");
  }
  glm::dmat4 world = node < 0 ? glm::dmat4(1) : worlds_[node];
  for (auto at = path.rbegin(); at != path.rend(); ++at) {
    world = world * local_matrix(document_.model().nodes[static_cast<std::size_t>(*at)]);
    worlds_[*at] = world;
  }
  return world;
}

const std::vector<glm::dmat4>& GltfSkins::pose(int index) {
  if (const auto known = poses_.find(index); known != poses_.end()) return known->second;
  const tinygltf::Skin& skin = document_.model().skins[static_cast<std::size_t>(index)];
  const std::string place = document_.place("skins", static_cast<std::size_t>(index));
  if (skin.joints.empty()) document_.fail(place + ".joints", "expected at least one joint");
  std::vector<float> binds;
  if (skin.inverseBindMatrices >= 0)
    binds = document_.floats(skin.inverseBindMatrices, 16, place + ".inverseBindMatrices");
  if (!binds.empty() && binds.size() < 16 * skin.joints.size())
    document_.fail(place + ".inverseBindMatrices", "expected a matrix for each joint");
  std::vector<glm::dmat4> pose;
  for (std::size_t i = 0; i < skin.joints.size(); ++i) {
    const glm::dmat4 joint_from_mesh =
        binds.empty() ? glm::dmat4(1) : glm::dmat4(glm::make_mat4(binds.data() + 16 * i));
    pose.push_back(world_from_node(skin.joints[i]) * joint_from_mesh);
  }
  return poses_[index] = std::move(pose);
}

void apply_skin(const GltfDocument& document, const GltfPrimitive& primitive,
                std::span<const glm::dmat4> world_from_joint, const std::string& place, Mesh& mesh) {
  const Blend blend(document, primitive, world_from_joint.size(), mesh.vertices.size(), place);
  std::size_t mirroring = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const glm::dmat4 world_from_mesh = blend.matrix(i, world_from_joint);
    const glm::dmat3 turn(world_from_mesh);
    const bool mirrors = glm::determinant(turn) < 0;
    mirroring += mirrors;
    Vertex& vertex = mesh.vertices[i];
    vertex.position = glm::vec3(world_from_mesh * glm::dvec4(glm::dvec3(vertex.position), 1));
    if (!glm::all(glm::lessThanEqual(glm::abs(vertex.position), glm::vec3(kFarthest))))
      document.fail(place, "its skin moves vertex " + std::to_string(i) +
                               " farther than 10,000 km from the origin; check the joints' scales");
    vertex.normal = turned(mirrors ? -cofactors(turn) : cofactors(turn), vertex.normal);
    vertex.tangent = glm::vec4(turned(turn, glm::vec3(vertex.tangent)), vertex.tangent.w);
  }
  if (2 * mirroring > mesh.vertices.size()) mesh = mirrored(mesh);
}

}  // namespace brume::scene
