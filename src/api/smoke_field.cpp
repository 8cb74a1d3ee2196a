#include "api/smoke_field.hpp"

#include <algorithm>
#include <array>
#include <tuple>

#include "sim/level_edit.hpp"
#include "smoke/drawn_sight.hpp"
#include "smoke/holes.hpp"

namespace brume::api {
namespace {

using sim::EditBlock;
using sim::EditBlocks;

constexpr int kBlock = 4;  // voxels per axis of an EditBlock

/// The blocks of two lists that are not in both.
EditBlocks differing(const EditBlocks& a, const EditBlocks& b) {
  const auto before = [](const EditBlock& x, const EditBlock& y) { return sim::block_before(x.at, y.at); };
  EditBlocks blocks;
  auto i = a.begin(), j = b.begin();
  while (i != a.end() || j != b.end()) {
    if (j == b.end() || (i != a.end() && before(*i, *j)))
      blocks.push_back({(i++)->at, 0, 0});
    else if (i == a.end() || before(*j, *i))
      blocks.push_back(*j++);
    else {
      if (*i != *j) blocks.push_back(*j);
      ++i, ++j;
    }
  }
  return blocks;
}

}  // namespace

SmokeField::SmokeField(std::shared_ptr<const LevelData> level, std::shared_ptr<const smoke::MaskAtlas> masks,
                       float extinction, std::vector<glm::ivec3> bricks)
    : level_(std::move(level)),
      masks_(std::move(masks)),
      extinction_(extinction),
      volume_(level_->grid, [this](glm::ivec3 cell) { return planes_at(cell); }) {
  sim::State empty;
  empty.layout = layout();
  empty.masks = this->masks();
  update(empty);
  replaced_bricks_ = std::move(bricks);
}

/// Surfaces are those of the level, but for cells with a voxel that is edited: there smoke ends at the
/// voxels' faces. So the field depends on the state alone, not on the order of its edits.
std::span<const voxel::Plane> SmokeField::planes_at(glm::ivec3 cell) const {
  if (changed_voxels_)
    for (int corner = 0; corner < 8; ++corner)
      if (changed_voxels_->solid(cell + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2))) return {};
  return level_->planes.at(cell);
}

void SmokeField::update(const sim::State& state) {
  sight_.reset();
  drawn_sight_.reset();
  follow_edits(state.edits);
  volume_.update(state, grid());
  find_changed_bricks();
  look(state);
  state_ = state;
}

void SmokeField::look(const sim::State& state) {
  holes_ = smoke::holes_of(state, masks_.get());
  sight_.emplace(volume_, solids().sight, holes_, state.seconds(state.tick), sight_settings());
}

smoke::SightSettings SmokeField::sight_settings() const {
  smoke::SightSettings settings;
  settings.extinction = extinction_;
  settings.masks = masks_.get();
  return settings;
}

std::shared_ptr<const smoke::Sight> SmokeField::drawn_sight(const smoke::NoiseLook& look) const {
  const std::lock_guard lock(drawn_mutex_);
  if (drawn_sight_ && drawn_look_ == look) return drawn_sight_;
  smoke::SmokeInput input{
      .volume = &volume_, .state = &state_, .holes = holes_, .time = state_.seconds(state_.tick)};
  smoke::set_noise(input.look, look);
  const auto drawn = std::make_shared<const smoke::DrawnSight>(input, solids().sight, sight_settings());
  drawn_look_ = look;
  drawn_sight_ = {drawn, &drawn->sight()};
  return drawn_sight_;
}

void SmokeField::find_changed_bricks() {
  // Slots that the update marked, and those beyond the last one now, whose bricks are gone.
  std::vector<glm::ivec3> changed = std::move(replaced_bricks_);
  replaced_bricks_.clear();
  const std::uint32_t count = volume_.slot_count();
  const auto add_before = [&](std::size_t slot) {
    if (slot < brick_of_slot_.size() && brick_of_slot_[slot]) changed.push_back(*brick_of_slot_[slot]);
  };
  for (std::size_t slot = count; slot < brick_of_slot_.size(); ++slot) add_before(slot);
  for (const std::uint32_t slot : volume_.dirty_slots()) add_before(slot);
  brick_of_slot_.resize(count);
  for (const std::uint32_t slot : volume_.dirty_slots()) {
    brick_of_slot_[slot].reset();
    if (!volume_.volume().in_use(slot)) continue;
    brick_of_slot_[slot] = volume_.brick_of(slot);
    changed.push_back(volume_.brick_of(slot));
  }

  // Each once, in order.
  std::sort(changed.begin(), changed.end(), [](const glm::ivec3& a, const glm::ivec3& b) {
    return std::tie(a.z, a.y, a.x) < std::tie(b.z, b.y, b.x);
  });
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  changed_bricks_.clear();
  const glm::ivec3 end = (layout().size + voxel::kBrickSize - 1) / voxel::kBrickSize;
  for (const glm::ivec3& brick : changed) {
    // Smoke is shown up to two voxels outside of the level.
    const bool inside =
        glm::all(glm::greaterThanEqual(brick, glm::ivec3(0))) && glm::all(glm::lessThan(brick, end));
    if (inside) changed_bricks_.push_back({brick.x, brick.y, brick.z});
  }
}

std::vector<glm::ivec3> SmokeField::bricks() const {
  std::vector<glm::ivec3> bricks = replaced_bricks_;
  for (const auto& brick : brick_of_slot_)
    if (brick) bricks.push_back(*brick);
  return bricks;
}

void SmokeField::follow_edits(const std::shared_ptr<const EditBlocks>& edits) {
  static const EditBlocks kNone;
  if (edits == edits_) return;
  const EditBlocks blocks = differing(edits_ ? *edits_ : kNone, edits ? *edits : kNone);
  if (!blocks.empty() && !edited_) {
    edited_.emplace(EditedLevel{level_->grid, level_->roles});
    changed_voxels_.emplace(layout());
  }
  for (const EditBlock& block : blocks) set_block(block);
  edits_ = edits;
}

/// Makes a block that of the level with these edits.
void SmokeField::set_block(const EditBlock& block) {
  const EditBlock now = sim::merge_edits(sim::content_of(level_->solids(), glm::ivec3(block.at)), block);
  sim::apply_edits(edited_->grid, edited_->roles, std::array{now});
  const std::uint64_t changed =
      sim::solid_bits(level_->grid, glm::ivec3(block.at)) ^ now.of_smoke().make_solid;
  sim::apply_edits(*changed_voxels_, std::array{EditBlock{block.at, changed, ~changed}});
  // The cells that have one of its voxels as a corner.
  const glm::ivec3 low = glm::ivec3(block.at) * kBlock;
  volume_.planes_changed(low - 1, low + kBlock - 1);
}

}  // namespace brume::api
