// The media of a scene: where light collides with them, and how much passes through.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "reference/emission_cells.hpp"
#include "reference/medium.hpp"

namespace brume::reference {

/// Where a ray is scattered or absorbed.
struct Collision {
  float t = 0;  ///< [m]
  const Medium* medium = nullptr;
};

/// The media of a scene, which must outlive it.
class Media {
 public:
  Media() = default;
  explicit Media(std::vector<std::unique_ptr<Medium>> media);

  /// The first collision along a ray, if it comes before the ray's end: delta tracking (Woodcock et al. 1965)
  /// in each medium, of which the nearest counts. Adds to `emitted` an estimate of what is emitted towards
  /// the ray's origin before that.
  std::optional<Collision> collide(const Ray& ray, Sampler& sampler, glm::vec3& emitted) const;
  /// An unbiased estimate of the transmittance of all media: residual ratio tracking (Novak et al. 2014,
  /// "Residual Ratio Tracking for Estimating Attenuation in Participating Media") with the cells' least
  /// extinctions as control, and Russian roulette.
  float transmittance(const Ray& ray, Sampler& sampler) const;

  std::span<const std::unique_ptr<Medium>> all() const { return media_; }
  /// Where they emit.
  const EmissionCells& emission() const { return emission_; }

 private:
  std::vector<std::unique_ptr<Medium>> media_;
  EmissionCells emission_;
};

}  // namespace brume::reference
