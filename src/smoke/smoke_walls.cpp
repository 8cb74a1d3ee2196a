// The part of SmokeVolume that knows where smoke meets walls: voxel masks, boundary cells, the layout.
#include <algorithm>
#include <bit>

#include "smoke/smoke_volume.hpp"

namespace brume::smoke {
namespace {

/// Bricks per axis of an atlas: as near to a cube as doublings get.
constexpr int kMaxAtlasBricks = 2048 / shared::kBrickTexels;

glm::ivec3 grown_atlas(glm::ivec3 bricks, std::uint64_t slots) {
  if (bricks.x == 0) bricks = glm::ivec3(4);
  while (static_cast<std::uint64_t>(bricks.x) * static_cast<std::uint64_t>(bricks.y) *
             static_cast<std::uint64_t>(bricks.z) <
         slots) {
    const int axis = bricks.x <= bricks.y && bricks.x <= bricks.z ? 0 : bricks.y <= bricks.z ? 1 : 2;
    bricks[axis] = std::min(2 * bricks[axis], kMaxAtlasBricks);
  }
  return bricks;
}

BrickBits smoke_of(const SmokeBrick& brick) {
  BrickBits bits{};
  for (const CloudPart& part : brick.clouds)
    for (std::size_t i = 0; i < 8; ++i)
      if (part.blocks[i] != kNoBlock)
        set_block(bits, i, part.source->cloud->voxels().blocks()[part.blocks[i]].mask);
  return bits;
}

/// Along each axis, bricks in which the cells around these voxels lie, cells voxel - 2 to voxel + 1.
struct Reach {
  glm::ivec3 low{0}, high{0};
};
Reach cells_reach(const BrickBits& voxels) {
  std::uint64_t flat = 0;
  for (const std::uint64_t word : voxels) flat |= word;
  Reach reach;
  reach.low.x = (flat & 0x0303030303030303u) != 0 ? -1 : 0;
  reach.high.x = (flat & 0x8080808080808080u) != 0 ? 1 : 0;
  reach.low.y = (flat & 0xffff) != 0 ? -1 : 0;
  reach.high.y = flat >> 56 != 0 ? 1 : 0;
  reach.low.z = (voxels[0] | voxels[1]) != 0 ? -1 : 0;
  reach.high.z = voxels[7] != 0 ? 1 : 0;
  return reach;
}

}  // namespace

void SmokeVolume::update_structure() {
  // More slots are touched on the way.
  for (std::size_t i = 0; i < touched_.size(); ++i)
    if (slots_[touched_[i]]->masks_stale) update_mask(touched_[i]);
  for (const glm::ivec3 at : stale_bricks_)
    if (const std::uint32_t slot = slot_at(at); slot != kNoSlot) mark(slot, &SmokeBrick::cells_stale);
  stale_bricks_.clear();
  free_unneeded();
  for (std::size_t i = 0; i < touched_.size(); ++i)
    if (SmokeBrick& brick = *slots_[touched_[i]]; brick.cells_stale) {
      structure_changed_ = true;
      build_cells(brick);
    }
  if (structure_changed_) update_layout();
}

/// Which voxels have smoke at some tick; cells that see one more or less are to be built anew.
void SmokeVolume::update_mask(std::uint32_t slot) {
  SmokeBrick& brick = *slots_[slot];
  const BrickBits smoke = smoke_of(brick);
  if (smoke == brick.smoke) return;
  BrickBits changed;
  for (std::size_t z = 0; z < 8; ++z) changed[z] = smoke[z] ^ brick.smoke[z];
  brick.smoke = smoke;
  pockets_.changed(brick.at, changed, stale_bricks_);
  const Reach reach = cells_reach(changed);
  const glm::ivec3 at = brick.at;
  for (int z = reach.low.z; z <= reach.high.z; ++z)
    for (int y = reach.low.y; y <= reach.high.y; ++y)
      for (int x = reach.low.x; x <= reach.high.x; ++x)
        if (const std::uint32_t other = slot_at(at + glm::ivec3(x, y, z)); other != kNoSlot)
          mark(other, &SmokeBrick::cells_stale);
}

/// Takes back the slots of bricks that no cloud needs.
void SmokeVolume::free_unneeded() {
  bool any = false;
  for (std::size_t i = 0; i < touched_.size(); ++i) {
    const std::uint32_t slot = touched_[i];
    const SmokeBrick& brick = *slots_[slot];
    if (!brick.live || brick.needed > 0) continue;
    free_slot(slot);
    any = true;
  }
  if (!any || slots_.back()->live) return;
  while (!slots_.empty() && !slots_.back()->live) slots_.pop_back();
  std::erase_if(touched_, [&](std::uint32_t slot) { return slot >= slots_.size(); });
  densities_.resize(slots_.size() * std::size_t{kVoxelsPerBrick});
  free_slots_ = {};
  for (std::uint32_t slot = 0; slot < slots_.size(); ++slot)
    if (!slots_[slot]->live) free_slots_.push(slot);
  if (slots_.empty()) pockets_ = {};
}

void SmokeVolume::fill_free(SmokeBrick& brick, const VoxelWindow& solid) {
  std::size_t texel = 0;
  for (std::size_t z = 0; z < 10; ++z)
    for (std::size_t y = 0; y < 10; ++y)
      for (unsigned x = 0; x < 10; ++x, ++texel) {
        const std::uint8_t free = (solid[z][y] >> x & 1) != 0 ? 0 : 255;
        brick.texels_changed |= brick.texels[texel].free != free;
        brick.texels[texel].free = free;
      }
}

void SmokeVolume::build_cells(SmokeBrick& brick) {
  drop_cells(brick);
  BrickScene scene{brick.at, window_of(solid_around(*grid_, brick.at)), {}, slots_around(brick.at)};
  if (brick.fresh || brick.walls_stale) fill_free(brick, scene.solid);
  std::array<const BrickBits*, 27> smoke{};
  for (std::size_t i = 0; i < 27; ++i)
    if (scene.slots[i] != kNoSlot) smoke[i] = &slots_[scene.slots[i]]->smoke;
  scene.smoke = window_of(smoke);

  const auto has_smoke = [this](glm::ivec3 v) {
    const std::uint32_t slot = slot_at(v >> 3);
    return slot != kNoSlot &&
           (slots_[slot]->smoke[static_cast<std::size_t>(v.z & 7)] >> (local_voxel(v) & 63) & 1) != 0;
  };
  const auto sealed = [&](glm::ivec3 v) {
    return grid_->free(v) && pockets_.sealed(*grid_, has_smoke, v, brick.at);
  };
  brick.home = builder_.build(scene, sealed);
  if (!brick.home) return;
  BrickCells& home = *brick.home;
  home.cell_range = cell_arena_.take(static_cast<std::uint32_t>(home.records.size()));
  home.set_range = set_arena_.take(home.set_count);
  if (boundary_cells_.size() < cell_arena_.end()) boundary_cells_.resize(cell_arena_.end());
  if (corner_sets_.size() < set_arena_.end()) corner_sets_.resize(set_arena_.end());
  for (std::size_t i = 0; i < home.records.size(); ++i) {
    shared::BoundaryCell record = home.records[i];
    record.first_set += home.set_range.first;
    boundary_cells_[home.cell_range.first + i] = record;
  }
  std::fill_n(corner_sets_.begin() + home.set_range.first, home.set_range.count, glm::uvec2(0));
  brick.home_changed = true;
  brick.stale_cells.fill(~std::uint64_t{0});
  write_cells(brick, false);
}

void SmokeVolume::drop_cells(SmokeBrick& brick) {
  if (!brick.home) return;
  write_cells(brick, true);
  cell_arena_.give_back(brick.home->cell_range);
  set_arena_.give_back(brick.home->set_range);
  brick.home.reset();
  brick.home_changed = false;
}

/// Writes the cells' numbers, or 0, into every brick in which their points may lie: this one and those above.
void SmokeVolume::write_cells(const SmokeBrick& brick, bool clear) {
  const BrickCells& home = *brick.home;
  std::array<std::uint32_t, 8> slots;
  for (int i = 0; i < 8; ++i) slots[static_cast<std::size_t>(i)] = slot_at(brick.at + corner_offset(i));
  for (std::size_t k = 0; k < home.cells.size(); ++k) {
    const glm::ivec3 local(home.cells[k] & 7, home.cells[k] >> 3 & 7, home.cells[k] >> 6);
    const glm::ivec3 last = (local + 1) >> 3;
    for (int i = 0; i < 8; ++i) {
      const glm::ivec3 step = corner_offset(i);
      const std::uint32_t slot = slots[static_cast<std::size_t>(i)];
      if (glm::any(glm::greaterThan(step, last)) || slot == kNoSlot) continue;
      SmokeBrick& into = *slots_[slot];
      if (!into.cells && clear) continue;
      if (!into.cells) into.cells = std::make_unique<std::array<std::uint32_t, shared::kCellsPerBrick>>();
      const glm::ivec3 at = local + 1 - 8 * step;
      (*into.cells)[static_cast<std::size_t>(at.x + 9 * (at.y + 9 * at.z))] =
          clear ? 0 : home.cell_range.first + static_cast<std::uint32_t>(k) + 1;
      mark(slot, &SmokeBrick::cells_changed);
    }
  }
}

void SmokeVolume::update_layout() {
  layout_.window_origin = pages_.origin();
  layout_.window_size = pages_.size();
  layout_.atlas_bricks = grown_atlas(layout_.atlas_bricks, slot_count());
  cloud_bounds_.clear();
  layout_.bounds_min = layout_.bounds_max = glm::vec3(0);
  for (const auto& source : sources_) {
    if (source->cloud->voxels().empty()) continue;
    // The cells that take from voxel v are v - 2 to v + 1; their points lie in [v - 1.5, v + 2.5].
    const SmokeBounds cloud{glm::vec3(source->cloud->low()) - 1.5f, glm::vec3(source->cloud->high()) + 2.5f};
    const bool first = cloud_bounds_.empty();
    layout_.bounds_min = first ? cloud.low : glm::min(layout_.bounds_min, cloud.low);
    layout_.bounds_max = first ? cloud.high : glm::max(layout_.bounds_max, cloud.high);
    cloud_bounds_.push_back(cloud);
  }
  if (slots_.empty()) {
    boundary_cells_.clear();
    corner_sets_.clear();
  }
}

}  // namespace brume::smoke
