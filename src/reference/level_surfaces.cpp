#include "reference/level_surfaces.hpp"

#include <algorithm>

namespace brume::reference {

LevelSurfaces::LevelSurfaces(const scene::Scene& scene, const planning::LevelState& level)
    : parts_(scene, {&level, 1}) {
  std::vector<trace::TriangleBvh::Triangle> triangles;
  for (const auto& part : parts_.all()) {
    first_triangles_.push_back(static_cast<std::uint32_t>(triangles.size()));
    const std::vector<glm::vec3>& corners = part->corners_world.front();
    const std::vector<std::uint32_t>& indices = part->mesh->indices;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
      triangles.push_back({corners[indices[i]], corners[indices[i + 1]], corners[indices[i + 2]]});
  }
  tree_ = trace::TriangleBvh(triangles);
}

LevelSurfaces::Triangle LevelSurfaces::triangle_of(std::uint32_t in_tree) const {
  const auto next = std::ranges::upper_bound(first_triangles_, in_tree);
  const auto part = static_cast<std::uint32_t>(next - first_triangles_.begin() - 1);
  return {part, in_tree - first_triangles_[part]};
}

std::optional<trace::TriangleBvh::Hit> LevelSurfaces::nearest(const Ray& ray) const {
  return tree_.nearest(ray.origin, ray.direction, ray.end, [this](const trace::TriangleBvh::Hit& hit) {
    const Triangle triangle = triangle_of(hit.triangle);
    const SurfaceParts::Part& part = *parts_.all()[triangle.part];
    return !part.has_holes() || !part.is_cut_out(triangle.number, hit.at);
  });
}

std::optional<LevelSurfaces::Place> LevelSurfaces::place(const Ray& ray) const {
  const auto found = nearest(ray);
  if (!found) return std::nullopt;
  const Triangle triangle = triangle_of(found->triangle);
  const SurfaceParts::Part& part = *parts_.all()[triangle.part];
  const auto corner = [&](std::size_t i) {
    return part.corners_world.front()[part.mesh->indices[std::size_t{3} * triangle.number + i]];
  };
  const glm::vec3 a = corner(0), across = part.handedness * glm::cross(corner(1) - a, corner(2) - a);
  const float length = glm::length(across);
  const glm::vec3 outward = length > 0 ? across / length : -ray.direction;
  const bool is_front = glm::dot(outward, ray.direction) < 0;
  return Place{ray.at(found->t), is_front ? outward : -outward, is_front};
}

std::optional<SurfaceHit> LevelSurfaces::hit(const Ray& ray) const {
  const auto found = nearest(ray);
  if (!found) return std::nullopt;
  const Triangle triangle = triangle_of(found->triangle);
  SurfaceHit hit;
  hit.t = found->t;
  hit.part = triangle.part;
  hit.triangle = triangle.number;
  parts_.shade(found->at, ray, hit);
  return hit;
}

}  // namespace brume::reference
