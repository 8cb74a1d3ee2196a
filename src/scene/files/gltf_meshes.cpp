#include "scene/files/gltf_meshes.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/log.hpp"
#include "scene/files/gltf_primitive.hpp"
#include "scene/files/mesh_tools.hpp"

namespace brume::scene {
namespace {

glm::vec3 unit_or(glm::vec3 vector, glm::vec3 otherwise) {
  const double length = glm::length(glm::dvec3(vector));
  return length > 1e-30 ? glm::vec3(glm::dvec3(vector) / length) : otherwise;
}

/// The attributes of a primitive that the renderer uses; all but the positions may be empty.
struct Attributes {
  std::vector<float> positions, normals, tangents, uvs, colors;
  int color_components = 0;
};

Attributes read_attributes(const GltfPrimitive& primitive, int uv_set) {
  Attributes read;
  read.positions = primitive.floats("POSITION", 3);
  read.normals = primitive.floats("NORMAL", 3);
  read.tangents = primitive.floats("TANGENT", 4);
  read.uvs = primitive.floats("TEXCOORD_" + std::to_string(uv_set), 2);
  read.color_components = primitive.components("COLOR_0") == 3 ? 3 : 4;
  read.colors = primitive.floats("COLOR_0", read.color_components);
  return read;
}

/// Adds so much of a morph target. Tangents keep their direction along the surface nearly enough.
void add_target(const GltfDocument& document, const std::map<std::string, int>& target, double weight,
                const std::string& place, Attributes& read) {
  const auto add = [&](const char* name, std::vector<float>& values) {
    const auto accessor = target.find(name);
    if (accessor == target.end() || values.empty()) return;
    const std::vector<float> moved = document.floats(accessor->second, 3, place + "." + name);
    if (moved.size() != values.size())
      document.fail(place + "." + name, "has another count than the primitive's positions");
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] += static_cast<float>(weight * static_cast<double>(moved[i]));
      if (!std::isfinite(values[i]))
        document.fail(place + "." + name, "with its weight goes beyond what floats hold");
    }
  };
  add("POSITION", read.positions);
  add("NORMAL", read.normals);
}

Vertex make_vertex(const Attributes& read, std::size_t i, const glm::mat3x2& image_from_uv) {
  Vertex vertex;
  const auto vector = [i](const std::vector<float>& values, std::size_t components) {
    return glm::vec3(values[components * i], values[components * i + 1], values[components * i + 2]);
  };
  vertex.position = vector(read.positions, 3);
  if (!read.uvs.empty()) vertex.uv = image_from_uv * glm::vec3(read.uvs[2 * i], read.uvs[2 * i + 1], 1);
  if (!read.normals.empty()) vertex.normal = unit_or(vector(read.normals, 3), {0, 1, 0});
  if (!read.tangents.empty()) {
    vertex.tangent =
        glm::vec4(unit_or(vector(read.tangents, 4), {1, 0, 0}), read.tangents[4 * i + 3] < 0 ? -1.0f : 1.0f);
  }
  if (!read.colors.empty()) {
    const auto components = static_cast<std::size_t>(read.color_components);
    const float alpha = components == 4 ? read.colors[4 * i + 3] : 1.0f;
    vertex.color = glm::clamp(glm::vec4(vector(read.colors, components), alpha), 0.0f, 1.0f);
  }
  return vertex;
}

/// Gives every corner a vertex of its own, so that computed normals are the triangles' own.
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
    : document_(document), materials_(materials), builder_(builder), skins_(document) {}

const std::vector<GltfMeshes::Part>& GltfMeshes::parts(int index, const std::vector<double>& weights,
                                                       int skin) {
  const std::tuple key(index, skin, weights);
  if (const auto known = parts_.find(key); known != parts_.end()) return known->second;
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
    Mesh mesh = convert(source.primitives[i], material, weights, skin, place);
    mesh.name = source.name.empty() ? "mesh " + std::to_string(index) : source.name;
    const Role role = materials_.role(material.index, mesh);
    parts.push_back({builder_.add_mesh(std::move(mesh)).value_or_throw(), material.index, role});
  }
  return parts_[key] = std::move(parts);
}

Mesh GltfMeshes::convert(const tinygltf::Primitive& source, const GltfMaterials::Converted& material,
                         const std::vector<double>& weights, int skin, const std::string& place) {
  const GltfPrimitive primitive(document_, source, place);
  Attributes read = read_attributes(primitive, material.uv_set);
  // Morph targets come before skins and normals.
  for (std::size_t i = 0; i < std::min(weights.size(), source.targets.size()); ++i)
    if (weights[i] != 0)
      add_target(document_, source.targets[i], weights[i], place + ".targets[" + std::to_string(i) + "]",
                 read);
  // Check the counts of all attributes against the positions.
  const std::size_t count = read.positions.size() / 3;
  if (count > kMostVertices) document_.fail(place, "has more vertices than a scene may have");
  const auto fits = [count](const std::vector<float>& values, int components) {
    return values.empty() || values.size() == count * static_cast<std::size_t>(components);
  };
  if (!fits(read.normals, 3) || !fits(read.tangents, 4) || !fits(read.uvs, 2) ||
      !fits(read.colors, read.color_components)) {
    document_.fail(place + ".attributes",
                   "have different counts; expected as many of each as there are positions");
  }

  Mesh mesh;
  mesh.vertices.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    mesh.vertices.push_back(make_vertex(read, i, material.image_from_uv));
  mesh.indices = primitive.triangles(count);
  if (skin >= 0) apply_skin(document_, primitive, skins_.pose(skin), place, mesh);
  // Without normals, faces are flat, as the format demands.
  if (read.normals.empty()) {
    separate_corners(mesh);
    compute_normals(mesh);
  }
  if (read.tangents.empty() || read.normals.empty()) compute_tangents(mesh);
  return mesh;
}

}  // namespace brume::scene
