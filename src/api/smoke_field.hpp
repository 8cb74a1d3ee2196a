// The density field of a level and what queries of it require. Worlds may advance, and end, while it is
// queried.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "api/objects.hpp"
#include "smoke/noise_look.hpp"
#include "smoke/sight.hpp"
#include "smoke/smoke_volume.hpp"

namespace brume::api {

class SmokeField {
 public:
  /// `bricks`: where a field that this one replaces had smoke.
  SmokeField(std::shared_ptr<const LevelData> level, std::shared_ptr<const smoke::MaskAtlas> masks,
             float extinction, std::vector<glm::ivec3> bricks = {});
  SmokeField(const SmokeField&) = delete;

  /// Takes over a state of the level's layout and with the field's masks. Throws what SmokeVolume::update
  /// does; it is then of no further use.
  void update(const sim::State& state);

  const voxel::GridLayout& layout() const { return level_->grid.layout(); }
  sim::MaskKey masks() const { return masks_ ? masks_->key() : sim::MaskKey{}; }
  const smoke::Sight& sight() const { return *sight_; }
  /// Queries of the drawn smoke; built on first use and kept until the next update. Thread-safe.
  std::shared_ptr<const smoke::Sight> drawn_sight(const smoke::NoiseLook& look) const;
  float extinction() const { return extinction_; }
  /// Those of the last state, of the field's masks.
  std::span<const shared::Hole> holes() const { return holes_; }
  const sim::State& state() const { return state_; }
  /// The level with the state's edits: what stops smoke, and all roles.
  const voxel::BitGrid& grid() const { return edited_ ? edited_->grid : level_->grid; }
  voxel::Solids solids() const {
    return edited_ ? voxel::Solids(edited_->grid, edited_->roles) : level_->solids();
  }
  const smoke::SmokeVolume& volume() const { return volume_; }
  /// The bricks in which the last update may have changed densities, by z, y, x.
  std::span<const brume_voxel> changed_bricks() const { return changed_bricks_; }
  /// Those with smoke, as of the last update that succeeded.
  std::vector<glm::ivec3> bricks() const;

 private:
  std::span<const voxel::Plane> planes_at(glm::ivec3 cell) const;
  void follow_edits(const std::shared_ptr<const sim::EditBlocks>& edits);
  void set_block(const sim::EditBlock& block);
  void look(const sim::State& state);
  smoke::SightSettings sight_settings() const;
  void find_changed_bricks();

  std::shared_ptr<const LevelData> level_;
  std::shared_ptr<const smoke::MaskAtlas> masks_;
  float extinction_;
  sim::State state_;                              // the last one
  std::shared_ptr<const sim::EditBlocks> edits_;  // of it
  struct EditedLevel {
    voxel::BitGrid grid;
    voxel::RoleGrids roles;
  };
  std::optional<EditedLevel> edited_;             // the level with them; none: no edits yet
  std::optional<voxel::BitGrid> changed_voxels_;  // where it differs for smoke; none: no edits yet
  smoke::SmokeVolume volume_;
  std::vector<shared::Hole> holes_;
  std::vector<std::optional<glm::ivec3>> brick_of_slot_;  // as of the last update
  std::vector<glm::ivec3> replaced_bricks_;               // changed, too, in the first update
  std::vector<brume_voxel> changed_bricks_;
  std::optional<smoke::Sight> sight_;
  mutable std::mutex drawn_mutex_;
  mutable smoke::NoiseLook drawn_look_;
  mutable std::shared_ptr<const smoke::Sight> drawn_sight_;  // with that look; null: none yet
};

}  // namespace brume::api

struct brume_field : brume::api::Handle {
  static constexpr auto kKind = brume::api::Kind::field;
  brume_field(std::shared_ptr<brume::api::Settings> of, std::shared_ptr<const brume::api::LevelData> of_level,
              std::shared_ptr<const brume::smoke::MaskAtlas> of_masks, float of_extinction)
      : Handle(kKind, std::move(of)),
        level(std::move(of_level)),
        masks(std::move(of_masks)),
        extinction(of_extinction) {
    renew();
  }
  /// The same without smoke.
  void renew() {
    std::vector<glm::ivec3> bricks;
    if (field) bricks = field->bricks();
    field = std::make_unique<brume::api::SmokeField>(level, masks, extinction, std::move(bricks));
  }

  std::shared_ptr<const brume::api::LevelData> level;
  std::shared_ptr<const brume::smoke::MaskAtlas> masks;
  float extinction;
  std::unique_ptr<brume::api::SmokeField> field;
};
