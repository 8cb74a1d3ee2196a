// The density field of a level and what queries of it require. Worlds may advance, and end, while it is
// queried.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "api/objects.hpp"
#include "smoke/field.hpp"

namespace brume::api {

/// The noise of drawn smoke, with its members in range; null: the defaults.
smoke::NoiseLook noise_look_of(const brume_drawn_params* given);

class SmokeField {
 public:
  /// `bricks`: where a field that this one replaces had smoke.
  SmokeField(std::shared_ptr<const LevelData> level, std::shared_ptr<const smoke::MaskAtlas> masks,
             float extinction, std::vector<glm::ivec3> bricks = {});
  SmokeField(const SmokeField&) = delete;

  /// Takes over a state of the level's layout and with the field's masks. Throws what smoke::Field::update
  /// does; it is then of no further use.
  void update(const sim::State& state);

  const smoke::Field& smoke() const { return field_; }
  const smoke::Sight& sight() const { return *sight_; }
  /// Queries of the drawn smoke; built on first use and kept until the next update. Thread-safe.
  std::shared_ptr<const smoke::Sight> drawn_sight(const smoke::NoiseLook& noise) const;
  float extinction() const { return extinction_; }
  /// The bricks in which the last update may have changed densities, by z, y, x. Thread-safe.
  std::vector<brume_voxel> changed_bricks() const;
  /// The bricks with smoke after the last update that succeeded.
  std::vector<glm::ivec3> bricks() const;

 private:
  void follow_slots();

  std::shared_ptr<const LevelData> level_;
  std::shared_ptr<const smoke::MaskAtlas> masks_;
  float extinction_;
  smoke::Field field_;
  std::shared_ptr<const smoke::Sight> sight_;             // without noise
  std::vector<std::optional<glm::ivec3>> brick_of_slot_;  // after the last update
  std::vector<glm::ivec3> replaced_bricks_;               // until the first update
  std::vector<glm::ivec3> gone_bricks_;                   // whose slots the last update released
};

}  // namespace brume::api

struct brume_field : brume::api::Handle {
  static constexpr auto kKind = brume::api::Kind::field;
  brume_field(std::shared_ptr<brume::api::Settings> context_settings,
              std::shared_ptr<const brume::api::LevelData> level_data,
              std::shared_ptr<const brume::smoke::MaskAtlas> mask_atlas, float smoke_extinction)
      : Handle(kKind, std::move(context_settings)),
        level(std::move(level_data)),
        masks(std::move(mask_atlas)),
        extinction(smoke_extinction) {
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
