#include "smoke/field.hpp"

#include <algorithm>

#include "core/same_bytes.hpp"
#include "smoke/drawn_sight.hpp"
#include "smoke/holes.hpp"

namespace brume::smoke {

DrawnLook drawn_look(const NoiseLook& noise) {
  DrawnLook look;
  set_noise(look.smoke, noise);
  return look;
}

bool SightLook::operator==(const SightLook& other) const {
  if (extinction != other.extinction || smoke_albedo != other.smoke_albedo) return false;
  if (!drawn || !other.drawn) return !drawn && !other.drawn;
  return same_bytes(drawn->smoke, other.drawn->smoke) && drawn->swirl_period == other.drawn->swirl_period;
}

Field::Field(const voxel::Solids& level, const voxel::SurfacePlanes& planes, const MaskAtlas* masks)
    : loaded_(level),
      loaded_planes_(planes),
      masks_(masks),
      edited_(level),
      patched_(planes),
      planes_([this](glm::ivec3 cell) { return planes_at(cell); }),
      volume_(level.smoke, planes_) {
  copied_.layout = layout();
  copied_.masks = this->masks();
  follow(copied_, loaded_);
}

std::span<const voxel::Plane> Field::planes_at(glm::ivec3 cell) const {
  if (const voxel::PlanePatch* patch = patched_.patch_at(cell)) return patch->planes.at(cell);
  const std::span<const voxel::Plane> planes = loaded_planes_.at(cell);
  if (planes.empty() || &now_->smoke == &loaded_.smoke) return planes;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 voxel = cell + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
    if (now_->smoke.solid(voxel) != loaded_.smoke.solid(voxel)) return {};
  }
  return planes;
}

void Field::update(const sim::State& state) {
  edited_.replace(state.edits);
  copied_ = state;
  follow(copied_, edited_.solids());
}

void Field::update(const sim::World& world) {
  follow(world.state(), world.solids());
}

void Field::follow(const sim::State& state, const voxel::Solids& now) {
  forget_sights();
  state_ = &state;
  now_.emplace(now);
  // It finds the cells around edited voxels, whose planes change with them.
  volume_.update(state, now.smoke);
}

void Field::set_patches(std::vector<std::shared_ptr<const voxel::PlanePatch>> patches) {
  const auto [was, is] = std::mismatch(patches_.begin(), patches_.end(), patches.begin(), patches.end());
  for (auto patch = was; patch != patches_.end(); ++patch) patch_changed(**patch);
  for (auto patch = is; patch != patches.end(); ++patch) patch_changed(**patch);

  // Patches that were covered by a patch that goes count again.
  auto to_add = is;
  if (was != patches_.end()) {
    patched_.clear();
    to_add = patches.begin();
  }
  for (; to_add != patches.end(); ++to_add) patched_.add(*to_add);
  patches_ = std::move(patches);
}

void Field::patch_changed(const voxel::PlanePatch& patch) {
  if (!patch.cells.empty()) volume_.planes_changed(patch.cells.low, patch.cells.high - 1);
}

void Field::forget_sights() {
  holes_.reset();
  for (KeptSight& kept : sights_) kept.sight.reset();
}

std::span<const shared::Hole> Field::holes() const {
  const std::lock_guard lock(mutex_);
  return find_holes();
}

/// With mutex_ locked, as make_sight.
std::span<const shared::Hole> Field::find_holes() const {
  if (!holes_) holes_ = make_holes(*state_, masks_);
  return *holes_;
}

std::shared_ptr<const Sight> Field::sight(const SightLook& look) const {
  const std::lock_guard lock(mutex_);
  KeptSight& kept = sights_[look.drawn ? 1 : 0];
  if (!kept.sight || kept.look != look) kept = {look, make_sight(look)};
  return kept.sight;
}

std::shared_ptr<const Sight> Field::make_sight(const SightLook& look) const {
  SightSettings settings;
  settings.extinction = look.extinction;
  settings.smoke_albedo = look.smoke_albedo;
  settings.masks = masks_;
  const float time = state_->seconds(state_->tick);
  const std::span<const shared::Hole> holes = find_holes();
  if (!look.drawn) return std::make_shared<const Sight>(volume_, now_->sight, holes, time, settings);
  const SmokeInput input{&volume_, state_, holes, look.drawn->smoke, look.drawn->swirl_period, time};
  const auto drawn = std::make_shared<const DrawnSight>(input, now_->sight, settings);
  return {drawn, &drawn->sight()};
}

}  // namespace brume::smoke
