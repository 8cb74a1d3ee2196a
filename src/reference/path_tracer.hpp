// Paths of light from the eye.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>

#include "reference/scene.hpp"
#include "surfaces/sampler.hpp"

namespace brume::reference {

/// Shortcuts; without them the mean of many paths is the picture.
struct PathLimits {
  /// Scatterings and reflections of a path, at most; 1: what lights reach at once.
  std::uint32_t max_bounces = std::numeric_limits<std::uint32_t>::max();
  float clamp = std::numeric_limits<float>::infinity();  ///< Largest component of what a path after its first
                                                         ///< bounce adds.
};

/// What one path from the eye found.
struct PathSample {
  glm::vec3 seen{0};               ///< Radiance of emitters and the sky, unscattered.
  glm::vec3 single{0};             ///< Scattered or reflected once.
  glm::vec3 multiple{0};           ///< More than once.
  glm::vec3 albedo{0}, normal{0};  ///< At the nearest surface; 0: none.
  float distance = std::numeric_limits<float>::infinity();  ///< Along the ray to it [m].
  bool through_media = true;  ///< The ray reached the surface or the sky without a collision.
};

/// An unbiased estimate of the radiance along a ray, but for `limits`: delta tracking, next-event estimation
/// at lights and emitters, joined with sampled directions by multiple importance sampling (Veach 1997), near
/// lights in media also with NearChords and LightPath, and Russian roulette.
PathSample trace_path(const Scene& scene, const Ray& ray, const PathLimits& limits, Sampler& sampler);

}  // namespace brume::reference
