// The planes of a level with local changes since they were built.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/box.hpp"
#include "voxel/surface_planes.hpp"

namespace brume::voxel {

/// Replaces the planes of a box of cells.
struct PlanePatch {
  Box<int> cells;
  SurfacePlanes planes;  ///< None outside of `cells`.
};

/// Base planes overlaid by patches; the latest patch wins.
class PatchedPlanes {
 public:
  /// `base` must outlive this object.
  explicit PatchedPlanes(const SurfacePlanes& base) : base_(base) {}

  /// As SurfacePlanes::at. Valid while the patch it comes from is alive.
  std::span<const Plane> at(glm::ivec3 cell) const {
    const PlanePatch* patch = patch_at(cell);
    return patch ? patch->planes.at(cell) : base_.at(cell);
  }
  /// The latest patch that contains the cell; null: none.
  const PlanePatch* patch_at(glm::ivec3 cell) const {
    for (auto patch = patches_.rbegin(); patch != patches_.rend(); ++patch)
      if ((*patch)->cells.contains(cell)) return patch->get();
    return nullptr;
  }

  /// Adds a patch on top and drops the patches it covers.
  void add(std::shared_ptr<const PlanePatch> patch) {
    std::erase_if(patches_, [&](const auto& other) { return patch->cells.contains(other->cells); });
    patches_.push_back(std::move(patch));
  }
  /// Removes all patches.
  void clear() { patches_.clear(); }

 private:
  const SurfacePlanes& base_;
  std::vector<std::shared_ptr<const PlanePatch>> patches_;
};

}  // namespace brume::voxel
