// What light is scattered and absorbed by between surfaces.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "reference/emission_cells.hpp"
#include "reference/majorants.hpp"
#include "shared/phase.h"
#include "surfaces/sampler.hpp"

namespace brume::reference {

/// Media overlap: their extinctions add up.
class Medium {
 public:
  explicit Medium(const shared::Phase& phase) : phase_(phase) {}
  virtual ~Medium() = default;

  /// [1/m], at most the bound of the point's cell.
  virtual float extinction(const glm::vec3& p_world) const = 0;
  /// Fraction of the lost light that is scattered, where the extinction is above 0.
  virtual glm::vec3 albedo(const glm::vec3& p_world) const = 0;
  /// Radiance that leaves a metre, whatever the extinction; 0 where the bound is 0.
  virtual glm::vec3 emission(const glm::vec3& p_world) const = 0;
  virtual bool emits() const { return false; }

  /// It moves while the shutter is open: `world_from_rest` at equal steps, affine; the first is the identity.
  /// All points above are relative to the medium at rest.
  void set_motion(std::vector<glm::mat4> world_from_rest);
  /// A ray past the medium at rest, of the same lengths.
  Ray at_rest(const Ray& ray) const;
  glm::vec3 world_from_rest(const glm::vec3& p_rest, float time) const;

  /// Collisions per length that tracking finds: the extinction, and 0 outside of all cells [1/m].
  float collisions(const glm::vec3& p_world) const;

  const shared::Phase& phase() const { return phase_; }
  const Majorants& majorants() const { return majorants_; }

 protected:
  Majorants majorants_;

 private:
  shared::Phase phase_;
  std::vector<glm::mat4> world_from_rest_;  // empty: it rests
};

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
