// A level with edits on top of its voxels as loaded.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "sim/level_edit.hpp"
#include "voxel/solids.hpp"

namespace brume::sim {

/// Its voxels depend on the level as loaded and on edits() alone, not on how they came about. The grids are
/// copied at the first edit; until then solids() refers to the level's.
class EditedLevel {
 public:
  /// The grids of `level` must outlive it unchanged.
  explicit EditedLevel(const voxel::Solids& level) : loaded_(level) {}

  const voxel::Solids& loaded() const { return loaded_; }
  /// Null: none.
  const std::shared_ptr<const EditBlocks>& edits() const { return edits_; }
  /// What stops smoke and shots, with the edits. Valid until the next change.
  const voxel::BitGrid& grid() const { return now_ ? now_->grid : loaded_.smoke; }
  /// The same for all roles.
  voxel::Solids solids() const { return now_ ? voxel::Solids(now_->grid, now_->roles) : loaded_; }

  /// Adds edits to those that it has.
  void add(const EditBlocks& more);
  /// Takes other edits in place of those that it has; null: none. Costs what differs between them.
  void replace(const std::shared_ptr<const EditBlocks>& edits);

 private:
  struct Grids {
    voxel::BitGrid grid;
    voxel::RoleGrids roles;
  };
  Grids& grids();

  const voxel::Solids loaded_;
  std::optional<Grids> now_;
  std::shared_ptr<const EditBlocks> edits_;
};

}  // namespace brume::sim
