// What scatters and absorbs light between surfaces: one medium.
#pragma once

#include <glm/glm.hpp>
#include <vector>

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

}  // namespace brume::reference
