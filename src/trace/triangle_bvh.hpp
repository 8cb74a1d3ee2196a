// Triangles for rays, without a library: Embree (triangle_tree.hpp) is faster, but what games embed does not
// bring it.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

namespace brume::trace {

/// A bounding volume hierarchy. No ray passes between triangles that have an edge in common, and results are
/// the same on all processors.
class TriangleBvh {
 public:
  using Triangle = std::array<glm::vec3, 3>;

  TriangleBvh();
  /// At most 2^30 triangles, finite; those without an area are never hit.
  explicit TriangleBvh(std::span<const Triangle> triangles);
  ~TriangleBvh();
  TriangleBvh(TriangleBvh&&) noexcept;
  TriangleBvh& operator=(TriangleBvh&&) noexcept;

  struct Hit {
    float t = 0;
    glm::vec2 at{0};  ///< Barycentric coordinates: weights of the second and the third corner.
    std::uint32_t triangle = 0;
  };
  /// Whether a hit counts: rays pass those that do not.
  using Accepts = std::function<bool(const Hit&)>;
  /// The nearest accepted hit, from either side, at origin + t * direction for t in (0, end]. The direction
  /// is finite and not 0.
  std::optional<Hit> nearest(const glm::vec3& origin, const glm::vec3& direction, float end,
                             const Accepts& accepts) const;

 private:
  struct Packet;
  struct Node;
  class Builder;

  std::vector<Packet> packets_;
  std::vector<Node> nodes_;  ///< The root first; empty without triangles.
};

}  // namespace brume::trace
