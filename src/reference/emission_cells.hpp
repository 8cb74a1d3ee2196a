// Where media emit, for next-event estimation: the cells of their majorants, by the power that they emit. A
// point of a cell gives a direction, and all that is emitted along it counts: Simon et al. 2017, "Line
// Integration for Rendering Heterogeneous Emissive Volumes". What is dense shows its front alone, wherever
// inside the point lies.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "reference/majorants.hpp"
#include "surfaces/sampler.hpp"

namespace brume::reference {

using surfaces::Sampler;

class Medium;

class EmissionCells {
 public:
  EmissionCells() = default;
  /// Cells of the media, which must outlive it.
  explicit EmissionCells(std::span<const Medium* const> media);

  bool empty() const { return power_up_to_.empty(); }

  /// A point of a cell at a time of the shutter, in proportion to the power of the cells and evenly within.
  glm::vec3 sample(float time, Sampler& sampler) const;
  /// Probability per solid angle that a sampled point lies in a direction from a ray's origin, whatever is in
  /// between [1/sr]: the integral of the density along the ray times the square of the distance.
  float direction_density(const Ray& ray) const;

 private:
  struct Lit {
    const Medium* medium = nullptr;
    std::vector<float> density;  // probability per volume, by cell of its majorants [1/m^3]
  };
  struct Cell {
    std::uint32_t medium = 0, cell = 0;
  };
  std::vector<Lit> media_;
  std::vector<Cell> cells_;
  std::vector<float> power_up_to_;  // by cell of cells_, of a whole of 1
};

}  // namespace brume::reference
