// Paths that begin at a light and are scattered by media, to be joined with paths from the eye: Lafortune and
// Willems 1996, "Rendering Participating Media with Bidirectional Path Tracing". Close to a light, paths from
// the eye are too rare for what they find there: bright dots.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "reference/scene.hpp"

namespace brume::reference {

/// What a vertex of a path tells about the density of paths through it. Extinctions and transmittances, which
/// all techniques that make a path share, or which are unknown, do not count.
struct Link {
  bool in_medium = false;
  float inverse_d2 = 0;  ///< 1 / squared distance to the vertex before [1/m^2].
  float density = 0;     ///< Per solid angle, of the direction to the vertex after [1/sr].
};

/// Sums the squares of the densities of other techniques that make the same path, relative to the density of
/// this one (Veach's power heuristic, 1995): those in which the last, the last two... of `links` come from
/// the other end of the path. `first_density`: Link::density of where the links begin; infinite if that end
/// always makes their first vertex. `last`: density with which the other end makes the last vertex [1/m^2],
/// `before`: with which that then goes on to the vertex before [1/sr]. At most `most` vertices change their
/// end, and only those in media.
double other_techniques(std::span<const Link> links, double first_density, double last, double before,
                        std::size_t most);

/// Vertices in media that light reaches from one of the scene's near lights.
class LightPath {
 public:
  static constexpr std::size_t kMostVertices = 16;

  struct Vertex {
    glm::vec3 position{0};
    glm::vec3 to_light{0};  ///< Direction to the vertex before, or to the light; unit.
    const Medium* medium = nullptr;
    glm::vec3 flux{0};  ///< Scattered here by the light that the path stands for [W].
  };

  /// Chooses a light for a path from the eye by its first vertex, or none, and traces a path from it.
  /// Dimensions from `dimension` on of the sampler count.
  void trace(const Scene& scene, const glm::vec3& first_vertex, float time, std::uint32_t dimension,
             Sampler& sampler);
  void clear();

  std::span<const Vertex> vertices() const { return vertices_; }
  std::span<const Link> links() const { return links_; }
  /// Link::density of the light that the path begins at, times the chance with which it was chosen [1/sr].
  float first_density() const { return first_density_; }
  /// The same of each of the scene's near lights; empty before trace, and if there are none.
  std::span<const float> first_densities() const { return first_densities_; }

 private:
  void choose(const Scene& scene, const glm::vec3& first_vertex);
  void scatter_from(const Scene& scene, const NearLight& near, float time, Sampler& sampler);

  std::vector<Vertex> vertices_;
  std::vector<Link> links_;
  std::vector<float> first_densities_;
  float first_density_ = 0;
};

}  // namespace brume::reference
