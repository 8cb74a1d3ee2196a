#include "smoke/smoke_volume.hpp"

#include <algorithm>

namespace brume::smoke {
namespace {

/// Numbers of voxels stay below 2^31.
constexpr std::uint32_t kMaxBricks = (1u << 31) / kVoxelsPerBrick;

bool intersect(const BrickBits& a, const BrickBits& b) {
  std::uint64_t any = 0;
  for (std::size_t z = 0; z < 8; ++z) any |= a[z] & b[z];
  return any != 0;
}

volume::SparseVolumeInfo volume_info(const voxel::GridLayout& grid) {
  return {grid.origin_world, grid.voxel_size, {volume::ChannelFormat{sizeof(Texel)}}, kMaxBricks};
}

}  // namespace

SmokeVolume::SmokeVolume(const voxel::BitGrid& grid, PlaneSource planes)
    : SmokeBricks(volume_),
      grid_layout_(grid.layout()),
      volume_(volume_info(grid_layout_)),
      densities_(volume_),
      walls_(volume_, std::move(planes)) {}

SmokeVolume::SmokeVolume(const voxel::BitGrid& grid, const voxel::SurfacePlanes& planes)
    : SmokeVolume(grid, [&planes](glm::ivec3 cell) { return planes.at(cell); }) {}

void SmokeVolume::update(const sim::State& state, const voxel::BitGrid& grid) {
  BRUME_ASSERT(grid.layout() == grid_layout_ && state.layout == grid_layout_, "the state is of another grid");
  grid_ = &grid;
  complete_.store(false, std::memory_order_relaxed);
  volume_.begin_update();
  walls_.begin_update();

  // What came, went or changed in the state.
  update_edits(state);
  update_clouds(state);
  update_sinks(state);

  // Bricks and the masks of where smoke can be, then what is stale of densities.
  update_structure();
  update_densities(state.tick);

  volume_.end_update();
  for (const std::uint32_t slot : touched_) bricks_[slot].touched = bricks_[slot].masks_stale = false;
  touched_.clear();
  if (structure_changed_) ++generation_;
  structure_changed_ = false;
}

/// Lists a slot for the update, because its clouds changed.
void SmokeVolume::mark_masks(std::uint32_t slot) {
  Brick& brick = bricks_[slot];
  if (!brick.touched) touched_.push_back(slot);
  brick.touched = brick.masks_stale = true;
}

/// Boundary cells of a slot are stale; `walls`: what is solid, too.
void SmokeVolume::mark_cells(std::uint32_t slot, bool walls) {
  Brick& brick = bricks_[slot];
  brick.cells_stale = true;
  brick.walls_stale |= walls;
  ready_[slot] = 0;
  structure_changed_ = true;
}

/// Densities of a brick, if it has a slot, are stale, and with them what the bricks around it copy.
void SmokeVolume::mark_densities(glm::ivec3 at) {
  const std::uint32_t slot = slot_at(at);
  if (slot == kNoSlot) return;
  bricks_[slot].densities_stale = true;
  for (const std::uint32_t around : volume_.slots_around(at))
    if (around != kNoSlot) ready_[around] = 0;
}

void SmokeVolume::update_clouds(const sim::State& state) {
  // Additions come before removals: no brick that stays loses its slot in between.
  const auto changes = sources_.take_clouds(state);
  for (SmokeSource* source : changes.added) add_cloud(*source);
  for (const auto& source : changes.removed) remove_cloud(*source);
  structure_changed_ |= changes.any();
}

void SmokeVolume::add_cloud(SmokeSource& source) {
  for (const glm::ivec3 brick : bricks_around(*source.cloud)) source.slots.push_back(take_brick(brick));
  const std::span<const sim::VoxelBlock> blocks = source.cloud->voxels().blocks();
  source.slot_of_block.reserve(blocks.size());
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const glm::ivec3 at(blocks[i].at);
    const std::uint32_t slot = slot_at(at >> 1);
    source.slot_of_block.push_back(slot);
    std::vector<CloudPart>& parts = bricks_[slot].clouds;
    if (parts.empty() || parts.back().source != &source) parts.push_back({&source, no_blocks()});
    parts.back().blocks[block_in_brick(at)] = static_cast<std::uint32_t>(i);
    mark_masks(slot);
  }
}

void SmokeVolume::remove_cloud(const SmokeSource& source) {
  for (const std::uint32_t slot : source.slots) {
    Brick& brick = bricks_[slot];
    std::erase_if(brick.clouds, [&](const CloudPart& part) { return part.source == &source; });
    mark_masks(slot);
    brick.densities_stale = true;
    ready_[slot] = 0;
    --brick.cloud_count;
  }
}

void SmokeVolume::update_sinks(const sim::State& state) {
  const auto changes = sources_.take_sinks(state);
  for (const SmokeSink* sink : changes.added) add_sink(*sink);
  for (const auto& sink : changes.removed) remove_sink(*sink);
}

void SmokeVolume::add_sink(const SmokeSink& sink) {
  for (const glm::ivec3 at : sink.bricks)
    if (const std::uint32_t slot = slot_at(at); slot != kNoSlot) {
      add_sink_part(at, sink, bricks_[slot].sinks);
      mark_densities(at);
    }
}

void SmokeVolume::remove_sink(const SmokeSink& sink) {
  for (const glm::ivec3 at : sink.bricks)
    if (const std::uint32_t slot = slot_at(at); slot != kNoSlot) {
      std::erase_if(bricks_[slot].sinks, [&](const SinkPart& part) { return part.sink == &sink; });
      mark_densities(at);
    }
}

void SmokeVolume::update_edits(const sim::State& state) {
  if (state.edits == edits_) return;
  const auto changed = [this](const sim::EditBlock& was, const sim::EditBlock& is) {
    const sim::EditBlock before = was.of_smoke(), after = is.of_smoke();
    const std::uint64_t mask = (before.make_solid ^ after.make_solid) | (before.make_free ^ after.make_free);
    if (mask != 0) voxels_changed(glm::ivec3(is.at), mask);
  };
  sim::for_each_difference(edits_.get(), state.edits.get(), changed);
  edits_ = state.edits;
}

/// Voxels of a block became solid or free.
void SmokeVolume::voxels_changed(glm::ivec3 block, std::uint64_t mask) {
  BrickBits bits{};
  set_block(bits, block_in_brick(block), mask);
  pockets_.changed(block >> 1, bits, stale_bricks_);
  mark_walls(sim::kBlockSize * block - 2, sim::kBlockSize * block + sim::kBlockSize + 1);
}

void SmokeVolume::planes_changed(glm::ivec3 low_cell, glm::ivec3 high_cell) {
  // A cell reads the planes of its neighbours; its brick is the one of its highest corner's voxel.
  mark_walls(low_cell - 1, high_cell + 2);
}

/// Marks all that depends on the walls of these voxels as stale.
void SmokeVolume::mark_walls(glm::ivec3 low_voxel, glm::ivec3 high_voxel) {
  const glm::ivec3 low = glm::max(low_voxel >> 3, 8 * pages().origin());
  const glm::ivec3 high = glm::min(high_voxel >> 3, 8 * (pages().origin() + pages().size()) - 1);
  if (glm::any(glm::lessThan(high, low))) return;

  // Over the slots where they are fewer than the bricks of the box.
  const glm::u64vec3 box(high - low + 1);
  if (box.x * box.y * box.z > slot_count()) {
    for (std::uint32_t slot = 0; slot < slot_count(); ++slot)
      if (volume_.in_use(slot) && glm::all(glm::greaterThanEqual(brick_of(slot), low)) &&
          glm::all(glm::lessThanEqual(brick_of(slot), high)))
        mark_cells(slot, true);
    return;
  }
  for (int z = low.z; z <= high.z; ++z)
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x)
        if (const std::uint32_t slot = slot_at({x, y, z}); slot != kNoSlot) mark_cells(slot, true);
}

/// The slot of the brick, a new one when it has none; one cloud more is in it.
std::uint32_t SmokeVolume::take_brick(glm::ivec3 at) {
  std::uint32_t slot = slot_at(at);
  if (slot == kNoSlot) {
    slot = volume_.acquire(at);
    if (slot >= bricks_.size()) {
      bricks_.resize(slot + 1);
      ready_.resize(slot + 1);
    }
    densities_.add(slot);
    walls_.add(slot);
    for (const auto& sink : sources_.sinks()) add_sink_part(at, *sink, bricks_[slot].sinks);
    mark_cells(slot, true);
    // Tables and aprons around it change.
    for (const std::uint32_t around : volume_.slots_around(at))
      if (around != kNoSlot) ready_[around] = 0;
  }
  ++bricks_[slot].cloud_count;
  return slot;
}

void SmokeVolume::release_brick(std::uint32_t slot) {
  walls_.remove(slot);
  const BrickBits changed = densities_.remove(slot);
  if (changed != BrickBits{}) walls_.densities_changed(brick_of(slot), changed);
  volume_.release(slot);
  bricks_[slot] = {};
  bricks_[slot].touched = true;
  ready_[slot] = 0;
}

/// Releases the bricks that no cloud is in.
void SmokeVolume::release_unneeded() {
  bool any = false;
  for (const std::uint32_t slot : touched_) {
    if (!volume_.in_use(slot) || bricks_[slot].cloud_count > 0) continue;
    release_brick(slot);
    any = true;
  }
  if (!any) return;
  densities_.shrink();
  walls_.shrink();
  bricks_.resize(slot_count());
  ready_.resize(slot_count());
  std::erase_if(touched_, [&](std::uint32_t slot) { return slot >= slot_count(); });
  if (bricks_.empty()) pockets_ = {};
}

void SmokeVolume::update_structure() {
  // Masks touch more slots, which have none of their own to update.
  for (std::size_t i = 0; i < touched_.size(); ++i)
    if (bricks_[touched_[i]].masks_stale) update_mask(touched_[i]);
  for (const glm::ivec3 at : stale_bricks_)
    if (const std::uint32_t slot = slot_at(at); slot != kNoSlot) mark_cells(slot, false);
  stale_bricks_.clear();
  release_unneeded();
  if (structure_changed_) update_bounds();
}

/// Which voxels have smoke at some tick; boundary cells that see one more or less are stale.
void SmokeVolume::update_mask(std::uint32_t slot) {
  Brick& brick = bricks_[slot];
  const BrickBits smoke = voxels_of(brick.clouds);
  if (smoke == brick.smoke) return;
  BrickBits changed;
  for (std::size_t z = 0; z < 8; ++z) changed[z] = smoke[z] ^ brick.smoke[z];
  brick.smoke = smoke;

  const glm::ivec3 at = brick_of(slot);
  pockets_.changed(at, changed, stale_bricks_);
  const volume::NeighbourSlots slots = volume_.slots_around(at);
  const std::array<BrickBits, 27> cells = cells_that_take(changed);
  for (std::size_t i = 0; i < 27; ++i)
    if (slots[i] != kNoSlot && intersect(cells[i], bricks_[slots[i]].cells_at_solid))
      mark_cells(slots[i], false);
}

void SmokeVolume::update_bounds() {
  cloud_bounds_.clear();
  glm::vec3 low(0), high(0);
  for (const auto& source : sources_.clouds()) {
    if (source->cloud->voxels().empty()) continue;
    // The cells that take from voxel v are v - 2 to v + 1; their points lie in [v - 1.5, v + 2.5].
    const Box<float> cloud{glm::vec3(source->cloud->low()) - 1.5f, glm::vec3(source->cloud->high()) + 2.5f};
    const bool first = cloud_bounds_.empty();
    low = first ? cloud.low : glm::min(low, cloud.low);
    high = first ? cloud.high : glm::max(high, cloud.high);
    cloud_bounds_.push_back(cloud);
  }
  volume_.set_bounds(low, high);
}

/// Where clouds and sinks changed since the last tick.
void SmokeVolume::update_densities(std::uint32_t tick) {
  moved_clouds_.clear();
  changed_slots_.clear();
  changed_bricks_.clear();
  sources_.advance_to(tick, moved_clouds_, changed_slots_, changed_bricks_);
  for (const std::uint32_t slot : changed_slots_) bricks_[slot].densities_stale = true;
  // Every brick that copies from a cloud's is one of those around it.
  for (const SmokeSource* source : moved_clouds_)
    for (const std::uint32_t slot : source->slots) ready_[slot] = 0;
  for (const glm::ivec3 at : changed_bricks_) mark_densities(at);
}

void SmokeVolume::prepare_now(std::uint32_t slot) const {
  const std::lock_guard lock(mutex_);
  if (!is_ready(slot)) prepare_locked(slot);
}

/// Texels and the list of boundary cells.
void SmokeVolume::prepare_locked(std::uint32_t slot) const {
  // Densities here and around.
  const glm::ivec3 at = brick_of(slot);
  const volume::NeighbourSlots around = volume_.slots_around(at);
  for (const std::uint32_t other : around) {
    if (other == kNoSlot || !bricks_[other].densities_stale) continue;
    const Brick& brick = bricks_[other];
    const BrickBits changed = densities_.set_densities(other, densities_of(brick.clouds, brick.sinks));
    if (changed != BrickBits{}) walls_.densities_changed(brick_of(other), changed);
    bricks_[other].densities_stale = false;
  }

  if (bricks_[slot].cells_stale) build_cells(slot, around);
  densities_.fill_new(slot);
  std::atomic_ref(ready_[slot]).store(1, std::memory_order_release);
}

void SmokeVolume::build_cells(std::uint32_t slot, const volume::NeighbourSlots& around) const {
  // What is solid and where smoke can be, in the brick and around it.
  Brick& brick = bricks_[slot];
  const VoxelWindow solid = make_window(solid_around(*grid_, brick_of(slot)));
  std::array<const BrickBits*, 27> smoke{};
  for (std::size_t i = 0; i < 27; ++i)
    if (around[i] != kNoSlot) smoke[i] = &bricks_[around[i]].smoke;
  if (brick.walls_stale) {
    densities_.set_solid(slot, solid);
    brick.cells_at_solid = cells_at_solid(solid);
  }
  walls_.build(slot, solid, make_window(smoke), brick.walls_stale);
  brick.walls_stale = brick.cells_stale = false;
}

/// For the boundary cells of a brick.
CellFormer::Sealed SmokeVolume::sealed_for(glm::ivec3 brick) const {
  const auto has_smoke = [this](glm::ivec3 v) {
    const std::uint32_t other = slot_at(v >> 3);
    return other != kNoSlot &&
           (bricks_[other].smoke[static_cast<std::size_t>(v.z & 7)] >> (local_voxel(v) & 63) & 1) != 0;
  };
  return [this, has_smoke, brick](glm::ivec3 v) {
    return grid_->free(v) && pockets_.sealed(*grid_, has_smoke, v, brick);
  };
}

void SmokeVolume::compute_cell(std::uint32_t slot, std::uint32_t cell) const {
  const std::lock_guard lock(mutex_);
  if (!walls_.computed(slot, cell))
    walls_.compute(slot, cell, densities_.densities(), sealed_for(brick_of(slot)));
}

void SmokeVolume::complete_now() const {
  const std::lock_guard lock(mutex_);
  if (complete_.load(std::memory_order_relaxed)) return;
  for (std::uint32_t slot = 0; slot < slot_count(); ++slot)
    if (volume_.in_use(slot) && !is_ready(slot)) prepare_locked(slot);
  walls_.compute_all(densities_.densities(), [this](glm::ivec3 brick) { return sealed_for(brick); });
  volume_.sort_dirty(kDensityChannel);
  complete_.store(true, std::memory_order_release);
}

std::uint64_t SmokeVolume::bytes() const {
  std::uint64_t sum = volume_.bytes() + densities_.bytes() + walls_.bytes() + sources_.bytes();
  for (const Brick& brick : bricks_)
    sum += sizeof(Brick) + brick.clouds.capacity() * sizeof(CloudPart) +
           brick.sinks.capacity() * sizeof(SinkPart);
  return sum;
}

float sample_density(const SmokeVolume& volume, glm::vec3 position_voxel) {
  const glm::ivec3 brick(glm::floor(position_voxel / 8.0f));
  const std::uint32_t slot = volume.slot_at(brick);
  if (slot == SmokeVolume::kNoSlot) return 0;

  // Trilinear density and fraction of free corners.
  const glm::ivec3 cell(glm::floor(position_voxel - 0.5f));
  const glm::vec3 f = position_voxel - 0.5f - glm::vec3(cell);
  const glm::ivec3 in_brick = cell - 8 * brick + 1;
  const std::span<const Texel> texels = volume.texels(slot);
  glm::uvec2 densities(0), frees(0);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 t = in_brick + corner_offset(corner);
    const Texel texel = texels[static_cast<std::size_t>(t.x + 10 * (t.y + 10 * t.z))];
    densities[corner >> 2] |= std::uint32_t{texel.density} << (8 * (corner & 3));
    frees[corner >> 2] |= std::uint32_t{texel.free} << (8 * (corner & 3));
  }
  const float plain = shared::corner_set_density(densities, f);
  if (shared::corner_set_density(frees, f) >= 1.0f - 1.0f / 512.0f) return plain;

  // A solid corner: the set for the point's side of the surface.
  const std::uint32_t home = volume.slot_at(brick_of_cell(cell)), number = cell_in_brick(cell);
  if (home == SmokeVolume::kNoSlot) return 0;
  const std::uint32_t entry = volume.entries(home)[number];
  if (entry == 0) return 0;  // no smoke near
  const shared::BoundaryCell& boundary = volume.boundary_cell(home, number, entry);
  const std::uint32_t side = shared::boundary_side(boundary, f - 0.5f);
  return shared::corner_set_density(volume.corner_set(boundary.first_set + side), f);
}

}  // namespace brume::smoke
