#include "planning/light_change_tracking.hpp"

#include <algorithm>
#include <string_view>
#include <tuple>
#include <unordered_set>

#include "core/same_bytes.hpp"

namespace brume::planning {
namespace {

glm::vec3 world_from_brick(const shared::VolumeLayout& layout, glm::ivec3 brick) {
  return layout.origin_world + glm::vec3(brick) * float{shared::kBrickVoxels} * layout.voxel_size;
}

const smoke::SmokeBricks& all_smoke(const SmokeLightInputs& inputs) {
  return inputs.all_smoke ? *inputs.all_smoke : *inputs.volume;
}

}  // namespace

bool same_opening(const shared::Hole& hole, float time_a, float time_b) {
  constexpr float kTolerance = 1e-3f;  // [s]: more than times round by
  const float wide = hole.time_start + hole.time_to_reach_far + std::max(hole.time_to_expand, 1e-6f);
  const float closing = hole.time_start + hole.time_to_expand + hole.time_to_stay_open;
  const float closed = wide + hole.time_to_stay_open + std::max(hole.time_to_fade, 1e-6f);
  const float first = std::min(time_a, time_b), last = std::max(time_a, time_b);
  return first == last || (first > wide + kTolerance && last < closing - kTolerance) ||
         last < hole.time_start - kTolerance || first > closed + kTolerance;
}

bool LightChangeTracker::is_continuous(const SmokeLightInputs& inputs) const {
  if (!last_ || inputs.volume->id() != last_->volume) return false;
  const shared::VolumeLayout& layout = inputs.volume->layout();
  if (layout.origin_world != layout_.origin_world || layout.voxel_size != layout_.voxel_size ||
      layout.bricks.atlas_bricks != layout_.bricks.atlas_bricks)
    return false;
  if (all_smoke(inputs).id() != last_->all_smoke) return false;
  // The dirty slots are those since the revision before, no older ones.
  const auto follows = [](std::uint64_t revision, std::uint64_t last) {
    return revision == last || revision == last + 1;
  };
  return follows(inputs.volume->revision(), last_->revision) &&
         follows(all_smoke(inputs).revision(), last_->all_revision);
}

bool LightChangeTracker::all_rays_changed(const SmokeLightInputs& inputs) const {
  return inputs.rebuild || !same_bytes(inputs.look, last_->look);
}

bool LightChangeTracker::smoke_changed(const SmokeLightInputs& inputs) const {
  return inputs.volume->revision() != last_->revision;
}

bool LightChangeTracker::noise_moved(const SmokeLightInputs& inputs) const {
  return inputs.look.erosion > 0 && (inputs.time != last_->time || inputs.noise_changed);
}

bool LightChangeTracker::caster_bounds_changed(const SmokeLightInputs& inputs) const {
  const Box<float>& bounds = inputs.visibility->caster_bounds;
  return last_->caster_bounds.low != bounds.low || last_->caster_bounds.high != bounds.high;
}

bool LightChangeTracker::gather_inputs_changed(const SmokeLightInputs& inputs) const {
  return !last_ || last_->viewpoint != inputs.viewpoint || !same_bytes(last_->sky, inputs.sky) ||
         last_->indirect_version != inputs.indirect_version;
}

void LightChangeTracker::add_hole_changes(const SmokeLightInputs& inputs,
                                          FrameVector<shared::LightChange>& changes) const {
  const float slack = layout_.voxel_size;  // holes are averaged over cells of half a voxel
  const auto add = [&](const shared::Hole& hole) {
    // A rim moves by a quarter of the radius at most; only boxes and masks have corners.
    const float reach = hole.shape == shared::kHoleCylinder ? 1.25f : shared::kHoleWidest;
    changes.push_back({hole.origin_world, hole.radius * reach + slack,
                       hole.origin_world + hole.distance_to_far * hole.forward, 0});
  };
  const auto bytes = [](const shared::Hole& hole) {
    return std::string_view(reinterpret_cast<const char*>(&hole), sizeof hole);
  };
  if (holes_.empty() && inputs.holes.empty()) return;
  std::pmr::unordered_set<std::string_view> gone(changes.get_allocator());
  for (const shared::Hole& hole : holes_) gone.insert(bytes(hole));
  for (const shared::Hole& hole : inputs.holes)
    if (gone.erase(bytes(hole)) == 0 || !same_opening(hole, last_->time, inputs.time)) add(hole);
  for (const shared::Hole& hole : holes_)
    if (gone.count(bytes(hole)) > 0) add(hole);
}

void LightChangeTracker::add_smoke_changes(const SmokeLightInputs& inputs,
                                           FrameVector<shared::LightChange>& changes) const {
  const smoke::SmokeBricks& smoke = all_smoke(inputs);
  if (smoke.revision() == last_->all_revision) return;
  // Cubes of four bricks, what changed in each as one.
  FrameVector<glm::ivec3> bricks(changes.get_allocator());
  bricks.reserve(2 * (smoke.dirty_slots().size() + smoke.dirty_cell_slots().size()));
  // A slot's brick, and the one that it held before.
  const auto add_slot = [&](std::uint32_t slot) {
    bricks.push_back(smoke.brick_of(slot));
    if (slot < brick_of_slot_.size()) bricks.push_back(brick_of_slot_[slot]);
  };
  for (const std::uint32_t slot : smoke.dirty_slots()) add_slot(slot);
  for (const std::uint32_t slot : smoke.dirty_cell_slots()) add_slot(slot);
  const auto cube_of = [](glm::ivec3 brick) { return std::tuple(brick.x >> 2, brick.y >> 2, brick.z >> 2); };
  std::sort(bricks.begin(), bricks.end(),
            [&](glm::ivec3 a, glm::ivec3 b) { return cube_of(a) < cube_of(b); });
  for (auto brick = bricks.begin(); brick != bricks.end();) {
    Box<int> changed{*brick, *brick + 1};
    const auto cube = cube_of(*brick);
    for (; brick != bricks.end() && cube_of(*brick) == cube; ++brick)
      changed = {glm::min(changed.low, *brick), glm::max(changed.high, *brick + 1)};
    // Corner sets of the bricks around change, too.
    const glm::vec3 low = world_from_brick(all_layout_, changed.low - 1);
    const glm::vec3 high = world_from_brick(all_layout_, changed.high + 1);
    const glm::vec3 middle = 0.5f * (low + high);
    changes.push_back({middle, 0.5f * glm::length(high - low), middle, 0});
  }
}

void LightChangeTracker::store_inputs(const SmokeLightInputs& inputs) {
  const smoke::SmokeBricks& smoke = all_smoke(inputs);
  const bool other_volume = !last_ || last_->all_smoke != smoke.id();
  last_ = {inputs.volume->id(),
           smoke.id(),
           inputs.volume->revision(),
           smoke.revision(),
           inputs.time,
           inputs.look,
           inputs.sky,
           inputs.viewpoint,
           inputs.visibility->caster_bounds,
           inputs.indirect_version};
  layout_ = inputs.volume->layout();
  all_layout_ = smoke.layout();
  holes_.assign(inputs.holes.begin(), inputs.holes.end());
  if (!other_volume && generation_ == smoke.structure_generation()) return;
  generation_ = smoke.structure_generation();
  brick_of_slot_.resize(smoke.slot_count());
  for (std::uint32_t slot = 0; slot < smoke.slot_count(); ++slot) brick_of_slot_[slot] = smoke.brick_of(slot);
}

}  // namespace brume::planning
