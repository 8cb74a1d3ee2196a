// The surfaces of a level at a time, for the rays that indirect light is prepared with.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "reference/surface_parts.hpp"
#include "trace/triangle_bvh.hpp"

namespace brume::reference {

/// As Surfaces, at one time, and without Embree, which libbrume would bring into every game
/// (docs/dependencies.md).
class LevelSurfaces {
 public:
  /// The scene must outlive it.
  LevelSurfaces(const scene::Scene& scene, const planning::LevelState& level);

  std::optional<SurfaceHit> hit(const Ray& ray) const;
  /// The nearest place of a surface on a ray, without its material.
  struct Place {
    glm::vec3 position{0};
    glm::vec3 normal{0};    ///< Unit, towards the ray's origin.
    bool is_front = false;  ///< The triangle is seen from outside.
  };
  std::optional<Place> place(const Ray& ray) const;

 private:
  /// A triangle of the tree.
  struct Triangle {
    std::uint32_t part = 0, number = 0;
  };
  Triangle triangle_of(std::uint32_t in_tree) const;
  std::optional<trace::TriangleBvh::Hit> nearest(const Ray& ray) const;

  SurfaceParts parts_;
  std::vector<std::uint32_t> first_triangles_;  ///< Of each part, in the tree.
  trace::TriangleBvh tree_;
};

}  // namespace brume::reference
