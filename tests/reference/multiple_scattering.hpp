// Light scattered many times in simple bodies of even smoke, by random walks in double: what the renderer's
// octaves are fitted to. Lengths are in free paths: the extinction is 1.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

namespace brume::reference {

/// A body of smoke around the origin.
struct Body {
  enum class Shape { slab, sphere, box };
  Shape shape = Shape::sphere;
  double half = 1;  ///< Half the thickness along z, the radius, or half the edge [free paths].
  bool contains(glm::dvec3 p) const;
  /// Length from a point of the body to its surface along a unit direction; at most 1e6.
  double exit_distance(glm::dvec3 p, glm::dvec3 direction) const;
};

/// A directional light of irradiance 1, or a point light that gives 1 at the body's middle.
struct BodyLight {
  bool directional = true;
  glm::dvec3 direction{0, 0, 1};  ///< Unit direction of a directional light.
  glm::dvec3 position{0};         ///< Of a point light, outside of the body.
  /// Of a directional light, as through a round hole: radius around the line through the origin [free paths].
  double beam = std::numeric_limits<double>::infinity();
};

/// Light that is scattered at a point of a body into one direction.
struct ScatteringSample {
  double g = 0, albedo = 1;
  double depth = 0;       ///< Optical depth to the light.
  double cos_angle = 0;   ///< Between the direction of the light and that to the eye.
  double escape = 1;      ///< Mean over all directions of exp(-distance to the surface).
  double irradiance = 1;  ///< Of the light at the point, as it would be without smoke.
  /// Radiance per unit of scattering coefficient after one scattering and after more than one; the standard
  /// deviation of the latter.
  double once = 0, more = 0, error = 0;
};

/// Samples of the same walks for several albedos: Henyey-Greenstein with g, light that arrives at `p` after
/// at least one scattering elsewhere and leaves it along `out`. The same for the same seed.
std::vector<ScatteringSample> walk_light(const Body& body, const BodyLight& light, double g,
                                         const std::vector<double>& albedos, glm::dvec3 p, glm::dvec3 out,
                                         std::uint32_t walks, std::uint64_t seed);

/// Samples in slabs, spheres and boxes from thin to thick, lit from afar and from nearby, from all sides: for
/// each g.
std::vector<ScatteringSample> scattering_samples(const std::vector<double>& gs,
                                                 const std::vector<double>& albedos, std::uint32_t walks,
                                                 std::uint64_t seed);

}  // namespace brume::reference
