// The planes of a level that has changed here and there since they were built.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "voxel/int_box.hpp"
#include "voxel/surface_planes.hpp"

namespace brume::voxel {

/// The planes of a stretch of cells, in the place of those before.
struct PlanePatch {
  IntBox cells;
  SurfacePlanes planes;  ///< None outside of `cells`.
};

/// Planes with patches over them, the last on top.
class PatchedPlanes {
 public:
  /// `base` must outlive it.
  explicit PatchedPlanes(const SurfacePlanes& base) : base_(base) {}

  /// As SurfacePlanes::at. Valid as long as the patch that it comes from is held by anybody.
  std::span<const Plane> at(glm::ivec3 cell) const {
    for (auto patch = patches_.rbegin(); patch != patches_.rend(); ++patch)
      if ((*patch)->cells.contains(cell)) return (*patch)->planes.at(cell);
    return base_.at(cell);
  }

  /// One more patch, on top. Those that it covers are let go.
  void add(std::shared_ptr<const PlanePatch> patch) {
    std::erase_if(patches_, [&](const auto& other) { return patch->cells.contains(other->cells); });
    patches_.push_back(std::move(patch));
  }
  /// As it was at the beginning.
  void clear() { patches_.clear(); }

 private:
  const SurfacePlanes& base_;
  std::vector<std::shared_ptr<const PlanePatch>> patches_;
};

}  // namespace brume::voxel
