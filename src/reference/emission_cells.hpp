// Where media emit, for next-event estimation: the cells of their majorants, by the power that they emit.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "reference/sampler.hpp"

namespace brume::reference {

class Medium;

class EmissionCells {
 public:
  EmissionCells() = default;
  /// Of the media that emit, which must outlive it.
  explicit EmissionCells(std::span<const Medium* const> media);

  bool empty() const { return power_up_to_.empty(); }

  struct Point {
    const Medium* medium = nullptr;
    glm::vec3 position{0};
    float density = 0;  ///< Probability per volume with which it is sampled [1/m^3].
  };
  /// A point of a cell, in proportion to the power of the cells and evenly within.
  Point sample(Sampler& sampler) const;
  /// Probability per volume of a point of a medium; 0 where its cell seemed to emit nothing.
  float density(const Medium& medium, const glm::vec3& p_world) const;

 private:
  struct Lit {
    const Medium* medium = nullptr;
    std::vector<float> density;  // by cell of its majorants
  };
  struct Cell {
    std::uint32_t medium = 0, cell = 0;
  };
  std::vector<Lit> media_;
  std::vector<Cell> cells_;
  std::vector<float> power_up_to_;  // by cell of cells_, of a whole of 1
};

}  // namespace brume::reference
