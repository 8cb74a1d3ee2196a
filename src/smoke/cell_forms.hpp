// What the corners of boundary cells take their densities from, past the surfaces in between. None of it
// changes from tick to tick, and most cells of a level have the same as others.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/hash.hpp"
#include "shared/smoke_volume.h"
#include "smoke/cell_sight.hpp"
#include "smoke/smoke_brick.hpp"

namespace brume::smoke {

/// For the points of a cell on one side of its planes: what each corner takes its density from. A corner on
/// that side takes its own, every other one a mean of voxels, weighted by distance.
struct FormSide {
  Neighbourhood64 visible = 0;            ///< All voxels that are visible from there.
  std::array<Neighbourhood64, 8> from{};  ///< By corner: what it takes the mean of; 0: no smoke.
  std::array<std::uint16_t, 8> total{};   ///< By corner: the sum of their weights.
  bool operator==(const FormSide&) const = default;
};

/// All of a boundary cell but its densities.
struct CellForm {
  std::array<std::uint32_t, 3> planes{};  ///< As shared::BoundaryCell has them.
  int side_count = 1;
  std::array<FormSide, 8> sides{};
  /// Whether smoke is part of it: its planes then follow where smoke can be. Else only walls are.
  bool bent = false;
};

/// A cell's surroundings.
struct CellSurroundings {
  glm::ivec3 cell{0};
  Neighbourhood64 free = 0;   ///< Outside of the grid too: smoke may end there.
  Neighbourhood64 smoke = 0;  ///< Where smoke is at some tick.
};

/// Makes the forms of single cells.
class CellFormer {
 public:
  /// Whether a voxel of the grid is free and no smoke comes into its space.
  using Sealed = std::function<bool(glm::ivec3 voxel)>;

  explicit CellFormer(const PlaneSource& planes) : planes_(planes), sight_(planes_) {}

  /// The cells that follow are of this brick, and planes may have changed.
  void move_to(glm::ivec3 brick);
  /// `sealed` is called for bent cells only.
  CellForm form(const CellSurroundings& cell, const Sealed& sealed);

 private:
  static Neighbourhood64 sealed_voxels(const CellSurroundings& cell, Neighbourhood64 among,
                                       const Sealed& sealed);
  float distance_to_surface(int plane, const std::array<Neighbourhood64, 8>& visible, Neighbourhood64 smoke,
                            Neighbourhood64 sealed) const;
  void reach_bent_surfaces(const CellSurroundings& cell, const Sealed& sealed,
                           std::array<Neighbourhood64, 8>& visible, CellForm& form);

  PlaneWindow planes_;
  CellSight sight_;
};

/// Each item once, by number.
template <typename Item>
class Interned {
 public:
  std::uint32_t number_of(const Item& item) {
    if (2 * (items_.size() + 1) > index_.size()) grow();
    const std::size_t place = place_of(item);
    if (index_[place] != 0) return index_[place] - 1;
    items_.push_back(item);
    index_[place] = static_cast<std::uint32_t>(items_.size());
    return index_[place] - 1;
  }
  const Item& operator[](std::uint32_t number) const { return items_[number]; }
  std::size_t size() const { return items_.size(); }
  void clear() {
    items_.clear();
    index_.clear();
  }
  std::uint64_t bytes() const {
    return items_.capacity() * sizeof(Item) + index_.capacity() * sizeof(std::uint32_t);
  }

 private:
  /// Where the item is in the index, or will be.
  std::size_t place_of(const Item& item) const {
    std::size_t place = hash_values(std::span(&item, 1)) & (index_.size() - 1);
    while (index_[place] != 0 && items_[index_[place] - 1] != item) place = (place + 1) & (index_.size() - 1);
    return place;
  }
  void grow() {
    index_.assign(std::max<std::size_t>(64, 2 * index_.size()), 0);
    for (std::size_t i = 0; i < items_.size(); ++i)
      index_[place_of(items_[i])] = static_cast<std::uint32_t>(i + 1);
  }

  std::vector<Item> items_;
  std::vector<std::uint32_t> index_;  // 2^k entries: number + 1, 0: none
};

/// The densities of the 4^3 voxels around a cell, as a Neighbourhood64 counts them.
using CellDensities = std::array<std::uint8_t, 64>;

/// Forms of many cells, each different one once.
class CellForms {
 public:
  std::uint32_t number_of(const CellForm& form);
  /// Removes all: numbers are free again.
  void clear();
  std::size_t size() const { return forms_.size(); }
  std::uint64_t bytes() const { return forms_.bytes() + sides_.bytes(); }

  /// The planes of a form.
  const std::array<std::uint32_t, 3>& planes(std::uint32_t form) const { return forms_[form].planes; }
  std::uint32_t side_count(std::uint32_t form) const { return forms_[form].side_count; }
  bool bent(std::uint32_t form) const { return forms_[form].bent != 0; }
  /// Whether corner_sets reads where smoke is.
  bool reads_smoke(std::uint32_t form) const { return forms_[form].hidden != 0; }
  /// The corner sets of a cell, one for each side of its planes. `smoke` is as in CellSurroundings.
  std::span<const glm::uvec2> corner_sets(std::uint32_t form, const CellDensities& densities,
                                          Neighbourhood64 smoke);

 private:
  struct Stored {
    std::array<std::uint32_t, 3> planes;
    std::uint16_t side_count, bent;
    std::uint32_t hidden;  // sides from which nothing is visible, a bit each
    std::array<std::uint32_t, 8> sides;
    bool operator==(const Stored&) const = default;
  };
  int side_to_follow(const Stored& form, int side, Neighbourhood64 smoke) const;

  Interned<Stored> forms_;
  Interned<FormSide> sides_;
  std::array<glm::uvec2, 8> sets_{};  // the last ones
};

}  // namespace brume::smoke
