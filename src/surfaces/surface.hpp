// How a surface reflects light: the model of shaders/lib/shading.glsl.
#pragma once

#include <glm/glm.hpp>

#include "surfaces/sampler.hpp"

namespace brume::surfaces {

/// Lambert below GGX with Schlick's Fresnel and Hammon's 2017 approximation of the height-correlated Smith
/// term. Directions point away from the surface, unit.
struct Reflection {
  glm::vec3 normal{0, 1, 0};
  glm::vec3 albedo{0};
  float roughness = 1;  ///< [0, 1], perceptual.
  float metallic = 0;
  float highlight = 1;  ///< Factor of Fresnel's term of what is no metal; 0: Lambert's law alone.

  /// Radiance towards `view` for unit irradiance of a surface that faces `to_light`: the reflectance times
  /// the cosine. 0 from below.
  glm::vec3 value(const glm::vec3& view, const glm::vec3& to_light) const;
  /// Probability per solid angle of sample [1/sr].
  float density(const glm::vec3& view, const glm::vec3& to_light) const;

  struct Direction {
    glm::vec3 to_light{0};
    glm::vec3 weight{0};  ///< value / density; 0: nothing is reflected.
    float density = 0;
  };
  Direction sample(const glm::vec3& view, Sampler& sampler) const;

 private:
  float specular_share(const glm::vec3& view) const;
};

/// Two unit vectors that complete a unit vector to a right-handed basis: Duff et al. 2017, "Building an
/// Orthonormal Basis, Revisited".
void basis_around(const glm::vec3& n, glm::vec3& x, glm::vec3& y);

}  // namespace brume::surfaces
