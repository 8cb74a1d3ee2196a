#include "api/smoke_field.hpp"

#include <algorithm>
#include <tuple>

namespace brume::api {

SmokeField::SmokeField(std::shared_ptr<const LevelData> level, std::shared_ptr<const smoke::MaskAtlas> masks,
                       float extinction, std::vector<glm::ivec3> bricks)
    : level_(std::move(level)),
      masks_(std::move(masks)),
      extinction_(extinction),
      field_(level_->solids(), level_->planes, masks_.get()),
      sight_(field_.sight({extinction_})),
      replaced_bricks_(std::move(bricks)) {}

void SmokeField::update(const sim::State& state) {
  sight_.reset();
  field_.update(state);
  follow_slots();
  sight_ = field_.sight({extinction_});
}

std::shared_ptr<const smoke::Sight> SmokeField::drawn_sight(const smoke::NoiseLook& noise) const {
  smoke::SightLook look{extinction_};
  look.drawn = smoke::drawn_look(noise);
  return field_.sight(look);
}

/// Which slots have which bricks now, and which bricks have none any longer.
void SmokeField::follow_slots() {
  gone_bricks_ = std::move(replaced_bricks_);
  replaced_bricks_.clear();
  const smoke::SmokeVolume& volume = field_.volume();
  const std::uint32_t count = volume.slot_count();
  const auto add_before = [&](std::size_t slot) {
    if (slot < brick_of_slot_.size() && brick_of_slot_[slot]) gone_bricks_.push_back(*brick_of_slot_[slot]);
  };
  for (std::size_t slot = count; slot < brick_of_slot_.size(); ++slot) add_before(slot);
  for (const std::uint32_t slot : volume.dirty_bricks()) add_before(slot);
  brick_of_slot_.resize(count);
  for (const std::uint32_t slot : volume.dirty_bricks()) {
    brick_of_slot_[slot].reset();
    if (volume.in_use(slot)) brick_of_slot_[slot] = volume.brick_of(slot);
  }
}

std::vector<brume_voxel> SmokeField::changed_bricks() const {
  std::vector<glm::ivec3> changed = gone_bricks_;
  for (const std::uint32_t slot : field_.volume().dirty_slots())
    if (brick_of_slot_[slot]) changed.push_back(*brick_of_slot_[slot]);

  // Each once, in order.
  std::sort(changed.begin(), changed.end(), [](const glm::ivec3& a, const glm::ivec3& b) {
    return std::tie(a.z, a.y, a.x) < std::tie(b.z, b.y, b.x);
  });
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  std::vector<brume_voxel> inside;
  const glm::ivec3 end = (field_.layout().size + voxel::kBrickSize - 1) / voxel::kBrickSize;
  for (const glm::ivec3& brick : changed) {
    // Smoke is shown up to two voxels outside of the level.
    if (glm::all(glm::greaterThanEqual(brick, glm::ivec3(0))) && glm::all(glm::lessThan(brick, end)))
      inside.push_back({brick.x, brick.y, brick.z});
  }
  return inside;
}

std::vector<glm::ivec3> SmokeField::bricks() const {
  std::vector<glm::ivec3> bricks = replaced_bricks_;
  for (const auto& brick : brick_of_slot_)
    if (brick) bricks.push_back(*brick);
  return bricks;
}

}  // namespace brume::api
