// The surfaces of a scene at a time, for the rays of the path tracer.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "reference/surface_parts.hpp"
#include "trace/triangle_tree.hpp"

namespace brume::reference {

class Surfaces {
 public:
  /// As SurfaceParts. Throws what TriangleTree::build fails with.
  Surfaces(const scene::Scene& scene, std::span<const planning::LevelState> levels, bool matte = false);

  std::optional<SurfaceHit> hit(const Ray& ray) const;
  /// Distance of the nearest surface on a ray; its end where there is none before [m].
  float distance(const Ray& ray) const;
  /// Whether a surface lies on a ray before its end.
  bool occluded(const Ray& ray) const;
  /// A ray's origin off a surface, on the side that `direction` leaves to.
  static glm::vec3 off_surface(const SurfaceHit& hit, const glm::vec3& direction);

  std::span<const Emitter> emitters() const { return parts_.emitters(); }
  /// Which of the emitters a hit surface is; nothing where it does not emit.
  std::optional<std::uint32_t> emitter_of(const SurfaceHit& hit) const { return parts_.emitter_of(hit); }

 private:
  RTCRayHit intersect(const Ray& ray) const;

  SurfaceParts parts_;  // part i is geometry i of the tree
  trace::TriangleTree tree_;
};

}  // namespace brume::reference
