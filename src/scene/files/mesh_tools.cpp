#include <cmath>

#include "scene/files/mesh_tools.hpp"

namespace brume::scene {
namespace {

/// A unit vector perpendicular to the unit vector n (Duff et al. 2017, "Building an Orthonormal Basis,
/// Revisited").
glm::vec3 perpendicular(glm::vec3 n) {
  const float sign = std::copysign(1.0f, n.z);
  const float a = -1.0f / (sign + n.z);
  return {1.0f + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x};
}

bool is_direction(glm::dvec3 v) {
  const double square = glm::dot(v, v);
  return std::isfinite(square) && square > 1e-300;
}

}  // namespace

void compute_tangents(Mesh& mesh) {
  // Sum the directions of u and v over each vertex' triangles.
  std::vector<glm::dvec3> along_u(mesh.vertices.size(), glm::dvec3(0));
  std::vector<glm::dvec3> along_v(mesh.vertices.size(), glm::dvec3(0));
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::uint32_t corner[3] = {mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]};
    const Vertex &a = mesh.vertices[corner[0]], &b = mesh.vertices[corner[1]], &c = mesh.vertices[corner[2]];
    const glm::dvec3 ab = glm::dvec3(b.position) - glm::dvec3(a.position);
    const glm::dvec3 ac = glm::dvec3(c.position) - glm::dvec3(a.position);
    const glm::dvec2 uv_ab = glm::dvec2(b.uv) - glm::dvec2(a.uv), uv_ac = glm::dvec2(c.uv) - glm::dvec2(a.uv);
    // Solve ab = uv_ab.x U + uv_ab.y V and the same for ac; only the directions of U and V matter.
    const double sign = uv_ab.x * uv_ac.y - uv_ac.x * uv_ab.y < 0 ? -1 : 1;
    const glm::dvec3 u = sign * (ab * uv_ac.y - ac * uv_ab.y);
    const glm::dvec3 v = sign * (ac * uv_ab.x - ab * uv_ac.x);
    if (!is_direction(u) || !is_direction(v)) continue;
    for (const std::uint32_t index : corner) {
      along_u[index] += glm::normalize(u);
      along_v[index] += glm::normalize(v);
    }
  }

  // Orthogonalize to the normal.
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    Vertex& vertex = mesh.vertices[i];
    const glm::dvec3 normal(vertex.normal);
    const glm::dvec3 tangent = along_u[i] - normal * glm::dot(normal, along_u[i]);
    if (glm::dot(tangent, tangent) < 1e-12) {
      vertex.tangent = glm::vec4(perpendicular(vertex.normal), 1);
      continue;
    }
    // v points down the image and the normal map's y points up: the bitangent opposes v.
    const double w = glm::dot(glm::cross(normal, tangent), along_v[i]) > 0 ? -1 : 1;
    vertex.tangent = glm::vec4(glm::vec3(glm::normalize(tangent)), static_cast<float>(w));
  }
}

void compute_normals(Mesh& mesh) {
  std::vector<glm::dvec3> sums(mesh.vertices.size(), glm::dvec3(0));
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const glm::dvec3 a(mesh.vertices[mesh.indices[i]].position);
    const glm::dvec3 b(mesh.vertices[mesh.indices[i + 1]].position);
    const glm::dvec3 c(mesh.vertices[mesh.indices[i + 2]].position);
    const glm::dvec3 area = glm::cross(b - a, c - a);
    for (std::size_t k = 0; k < 3; ++k) sums[mesh.indices[i + k]] += area;
  }
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    mesh.vertices[i].normal = is_direction(sums[i]) ? glm::vec3(glm::normalize(sums[i])) : glm::vec3(0, 1, 0);
  }
}

Mesh mirrored(const Mesh& mesh) {
  Mesh result = mesh;
  for (std::size_t i = 0; i + 2 < result.indices.size(); i += 3) {
    std::swap(result.indices[i + 1], result.indices[i + 2]);
  }
  for (Vertex& vertex : result.vertices) vertex.tangent.w = -vertex.tangent.w;
  return result;
}

void centre(Mesh& mesh) {
  glm::dvec3 low(1e300), high(-1e300);
  for (const Vertex& vertex : mesh.vertices) {
    low = glm::min(low, glm::dvec3(vertex.position));
    high = glm::max(high, glm::dvec3(vertex.position));
  }
  const glm::dvec3 middle = (low + high) / 2.0;
  for (Vertex& vertex : mesh.vertices) vertex.position = glm::vec3(glm::dvec3(vertex.position) - middle);
}

}  // namespace brume::scene
