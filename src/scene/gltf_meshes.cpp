#include <cmath>
#include <numeric>

#include "core/log.hpp"
#include "scene/gltf_parts.hpp"
#include "scene/mesh_tools.hpp"

namespace brume::scene {
namespace {

glm::vec3 unit_or(glm::vec3 vector, glm::vec3 otherwise) {
  const double length = glm::length(glm::dvec3(vector));
  return length > 1e-30 ? glm::vec3(glm::dvec3(vector) / length) : otherwise;
}

/// The corners of separate triangles, from a list, a strip or a fan of corners.
std::vector<std::uint32_t> as_triangles(const std::vector<std::uint32_t>& corners, int mode) {
  if (mode == TINYGLTF_MODE_TRIANGLES) return corners;
  std::vector<std::uint32_t> triangles;
  for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
    // Every second triangle of a strip has the opposite winding.
    const std::size_t swap = mode == TINYGLTF_MODE_TRIANGLE_STRIP ? i % 2 : 0;
    triangles.push_back(corners[mode == TINYGLTF_MODE_TRIANGLE_FAN ? 0 : i]);
    triangles.push_back(corners[i + 1 + swap]);
    triangles.push_back(corners[i + 2 - swap]);
  }
  return triangles;
}

/// Gives every corner a vertex of its own, so that computed normals are those of the triangles.
void separate_corners(Mesh& mesh) {
  std::vector<Vertex> vertices;
  vertices.reserve(mesh.indices.size());
  for (std::uint32_t& index : mesh.indices) {
    vertices.push_back(mesh.vertices[index]);
    index = static_cast<std::uint32_t>(vertices.size() - 1);
  }
  mesh.vertices = std::move(vertices);
}

}  // namespace

GltfMeshes::GltfMeshes(const GltfDocument& document, GltfMaterials& materials, SceneBuilder& builder)
    : document_(document), materials_(materials), builder_(builder) {}

const std::vector<GltfMeshes::Part>& GltfMeshes::parts(int index) {
  if (const auto known = parts_.find(index); known != parts_.end()) return known->second;
  const auto at = static_cast<std::size_t>(index);
  const tinygltf::Mesh& source = document_.model().meshes[at];
  std::vector<Part> parts;
  for (std::size_t i = 0; i < source.primitives.size(); ++i) {
    const std::string place = document_.place("meshes", at) + ".primitives[" + std::to_string(i) + "]";
    if (source.primitives[i].mode < TINYGLTF_MODE_TRIANGLES) {
      log_warning(place + ": points and lines are not drawn");
      continue;
    }
    const auto material = materials_.material(source.primitives[i].material);
    Mesh mesh = convert(source.primitives[i], material.uv_set, place);
    mesh.name = source.name.empty() ? "mesh " + std::to_string(index) : source.name;
    parts.push_back({builder_.add_mesh(std::move(mesh)).value_or_throw(), material.index});
  }
  return parts_[index] = std::move(parts);
}

Mesh GltfMeshes::convert(const tinygltf::Primitive& primitive, int uv_set, const std::string& place) {
  // The attributes.
  const auto read = [&](const std::string& key, int components) {
    const auto accessor = primitive.attributes.find(key);
    return accessor == primitive.attributes.end()
               ? std::vector<float>()
               : document_.floats(accessor->second, components, place + ".attributes." + key);
  };
  const std::vector<float> positions = read("POSITION", 3), normals = read("NORMAL", 3),
                           tangents = read("TANGENT", 4), uvs = read("TEXCOORD_" + std::to_string(uv_set), 2);
  const std::size_t count = positions.size() / 3;
  if (count > kMostVertices) document_.fail(place, "has more vertices than a scene may have");
  if ((!normals.empty() && normals.size() != count * 3) ||
      (!tangents.empty() && tangents.size() != count * 4) || (!uvs.empty() && uvs.size() != count * 2)) {
    document_.fail(place + ".attributes",
                   "have different counts; expected as many of each as there are positions");
  }

  // Vertices.
  Mesh mesh;
  mesh.vertices.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    Vertex& vertex = mesh.vertices[i];
    vertex.position = {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]};
    if (!uvs.empty()) vertex.uv = {uvs[2 * i], uvs[2 * i + 1]};
    if (!normals.empty())
      vertex.normal = unit_or({normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]}, {0, 1, 0});
    if (!tangents.empty()) {
      const glm::vec3 tangent =
          unit_or({tangents[4 * i], tangents[4 * i + 1], tangents[4 * i + 2]}, {1, 0, 0});
      vertex.tangent = glm::vec4(tangent, tangents[4 * i + 3] < 0 ? -1.0f : 1.0f);
    }
  }

  // Indices, as triangles.
  std::vector<std::uint32_t> corners(count);
  if (primitive.indices >= 0) {
    corners = document_.indices(primitive.indices, place + ".indices");
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (corners[i] >= count) {
        document_.fail(place + ".indices", "index " + std::to_string(corners[i]) + " (number " +
                                               std::to_string(i) + ") is out of range: the primitive has " +
                                               std::to_string(count) + " vertices");
      }
    }
  } else {
    std::iota(corners.begin(), corners.end(), 0u);
  }
  if (primitive.mode == TINYGLTF_MODE_TRIANGLES && corners.size() % 3 != 0)
    document_.fail(place, "has " + std::to_string(corners.size()) + " corners; expected a multiple of 3");
  mesh.indices = as_triangles(corners, primitive.mode);
  if (normals.empty()) {
    separate_corners(mesh);
    compute_normals(mesh);
  }
  if (tangents.empty() || normals.empty()) compute_tangents(mesh);
  return mesh;
}

}  // namespace brume::scene
