#include "planning/resident_smoke.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <tuple>

#include "core/box.hpp"

namespace brume::planning {
namespace {

using smoke::kDensityChannel;
using smoke::Texel;

constexpr std::array<std::uint32_t, shared::kCellsPerBrick> kNoCells{};

bool before(glm::ivec3 a, glm::ivec3 b) {
  return std::tie(a.z, a.y, a.x) < std::tie(b.z, b.y, b.x);
}

template <typename Bricks>
void sort_once(Bricks& bricks) {
  std::sort(bricks.begin(), bricks.end(), before);
  bricks.erase(std::unique(bricks.begin(), bricks.end()), bricks.end());
}

volume::SparseVolume empty_volume(glm::vec3 origin_world, float voxel_size, glm::ivec3 atlas) {
  volume::SparseVolumeInfo info;
  info.origin_world = origin_world;
  info.voxel_size = voxel_size;
  info.channels = {{sizeof(Texel)}};
  info.atlas_bricks = atlas;
  return volume::SparseVolume(info);
}

/// How many voxels beside a coarse one count for its density. A point that it is interpolated at lies less
/// than a coarse voxel from its middle, and takes from voxels less than one away: those up to 1.5 2^level,
/// and one more for what walls extrapolate.
int reach_of(int level) {
  return (1 << level) / 2 + 2;
}

/// The voxels of the simulation that a coarse brick, apron included, takes from.
Box<int> taken_from(int level, glm::ivec3 brick) {
  const int scale = 1 << level, reach = reach_of(level);
  return {scale * (shared::kBrickVoxels * brick - 1) - reach,
          scale * (shared::kBrickVoxels * (brick + 1) + 1) + reach};
}

std::size_t room_of(glm::ivec3 atlas) {
  const glm::u64vec3 bricks(atlas);
  return bricks.x * bricks.y * bricks.z;
}

void nearest_first(std::span<glm::ivec3> bricks, glm::vec3 eye_brick) {
  std::sort(bricks.begin(), bricks.end(), [&](glm::ivec3 a, glm::ivec3 b) {
    const glm::vec3 to_a = glm::vec3(a) + 0.5f - eye_brick, to_b = glm::vec3(b) + 0.5f - eye_brick;
    const float distance_a = glm::dot(to_a, to_a), distance_b = glm::dot(to_b, to_b);
    return distance_a != distance_b ? distance_a < distance_b : before(a, b);
  });
}

/// Adds what is in `others` but not in `known`; both are in order.
void add_others(std::span<const glm::ivec3> known, std::span<const glm::ivec3> others,
                FrameVector<glm::ivec3>& bricks) {
  std::set_difference(others.begin(), others.end(), known.begin(), known.end(), std::back_inserter(bricks),
                      before);
}

}  // namespace

void fill_coarse_brick(const smoke::SmokeVolume& volume, int level, glm::ivec3 brick,
                       std::span<Texel, shared::kTexelsPerBrick> texels) {
  std::fill(texels.begin(), texels.end(), Texel{0, 255});
  const int reach = reach_of(level);
  const glm::ivec3 first = shared::kBrickVoxels * brick - 1;
  const Box<int> from = taken_from(level, brick);
  // The texels along an axis that a voxel counts for.
  const auto texels_of = [&](glm::ivec3 voxel) {
    return Box<int>{glm::max(((voxel - reach) >> level) - first, glm::ivec3(0)),
                    glm::min(((voxel + reach) >> level) - first + 1, glm::ivec3(shared::kBrickTexels))};
  };
  for_each_in(Box<int>{from.low >> 3, ((from.high - 1) >> 3) + 1}, [&](glm::ivec3 fine) {
    const std::uint32_t slot = volume.slot_at(fine);
    if (slot == smoke::SmokeVolume::kNoSlot) return;
    const auto own = volume.texels(slot);
    for_each_in(Box<int>{glm::ivec3(0), glm::ivec3(shared::kBrickVoxels)}, [&](glm::ivec3 local) {
      const glm::ivec3 at = local + 1;
      const std::uint8_t density = own[static_cast<std::size_t>(at.x + 10 * (at.y + 10 * at.z))].density;
      if (density == 0) return;
      for_each_in(texels_of(shared::kBrickVoxels * fine + local), [&](glm::ivec3 texel) {
        Texel& out = texels[static_cast<std::size_t>(texel.x + 10 * (texel.y + 10 * texel.z))];
        out.density = std::max(out.density, density);
      });
    });
  });
}

ResidentSmoke::ResidentSmoke() : SmokeBricks(held_), held_(empty_volume(glm::vec3(0), 1, glm::ivec3(0))) {}

/// The finest level at which what is in view has room, and its bricks there; finer than now only where there
/// is room to spare, so that smoke does not change its level from frame to frame.
FrameVector<glm::ivec3> ResidentSmoke::choose_level(const Request& request, const SmokeVisibility& visible,
                                                    int& level, Allocator memory) const {
  FrameVector<glm::ivec3> in_view(memory);
  in_view.reserve(visible.visible_count);
  for (std::uint32_t i = 0; i < visible.visible_count; ++i)
    in_view.push_back(request.volume.brick_of(visible.slots[i]));
  const std::size_t most = request.most_bricks;
  for (level = 0;; ++level) {
    if (level > 0) sort_once(in_view);  // else each slot is a brick of its own
    if (level == kMostLevel || in_view.size() <= (level < level_ ? most - most / 4 : most)) return in_view;
    for (glm::ivec3& brick : in_view) brick >>= 1;
  }
}

/// What there is to hold at a level, as far as there is room; `in_view`: the bricks that are, each once.
ResidentSmoke::Wanted ResidentSmoke::wanted_at(int level, const Request& request,
                                               const SmokeVisibility& visible,
                                               FrameVector<glm::ivec3> in_view) {
  const Allocator memory = in_view.get_allocator();
  const smoke::SmokeVolume& volume = request.volume;
  const shared::VolumeLayout& layout = volume.layout();
  const float edge = layout.voxel_size * static_cast<float>(shared::kBrickVoxels << level);
  const glm::vec3 eye_brick = (request.eye_world - layout.origin_world) / edge;
  const std::size_t most = request.most_bricks;
  Wanted wanted{.bricks = std::move(in_view)};
  wanted.visible = wanted.bricks.size();
  const auto casters = std::span(visible.slots).subspan(visible.visible_count);
  // As in most frames: each slot is a brick of its own, and there is room for all.
  if (level == 0 && !request.all && visible.slots.size() <= most) {
    for (const std::uint32_t slot : casters) wanted.bricks.push_back(volume.brick_of(slot));
    wanted.required = wanted.bricks.size();
    return wanted;
  }
  std::sort(wanted.bricks.begin(), wanted.bricks.end(), before);
  const auto bricks_of = [&](std::span<const std::uint32_t> slots) {
    FrameVector<glm::ivec3> bricks(memory);
    bricks.reserve(slots.size());
    for (const std::uint32_t slot : slots) bricks.push_back(volume.brick_of(slot) >> level);
    sort_once(bricks);
    return bricks;
  };
  const auto end_of = [&](std::size_t count) { return static_cast<std::ptrdiff_t>(count); };
  const auto cut = [&](std::size_t first, std::size_t count) {
    nearest_first(std::span(wanted.bricks).subspan(first), eye_brick);
    wanted.bricks.resize(first + count);
    wanted.is_limited = true;
  };

  // What is in view.
  if (wanted.visible > most) {
    cut(0, most);
    wanted.visible = most;
    std::sort(wanted.bricks.begin(), wanted.bricks.end(), before);
  }
  // What dims its light, and what else the indirect light comes from.
  FrameVector<glm::ivec3> held(wanted.bricks, memory);
  const auto add = [&](std::span<const std::uint32_t> slots) {
    const std::size_t first = wanted.bricks.size();
    add_others(held, bricks_of(slots), wanted.bricks);
    if (wanted.bricks.size() > most) cut(first, most - first);
    held.insert(held.end(), wanted.bricks.begin() + end_of(first), wanted.bricks.end());
    std::sort(held.begin(), held.end(), before);
  };
  add(casters);
  wanted.required = wanted.bricks.size();
  if (request.all) add(all_smoke_visible(volume, memory).slots);
  return wanted;
}

/// Holds nothing, in an atlas of this size.
void ResidentSmoke::restart(const smoke::SmokeVolume& source, int level, glm::ivec3 atlas) {
  const shared::VolumeLayout& layout = source.layout();
  held_ = empty_volume(layout.origin_world, layout.voxel_size * static_cast<float>(1 << level), atlas);
  level_ = level;
  updating_ = false;
  last_frame_.clear();
  source_id_ = source.id();
  source_revision_ = source.revision();
  source_generation_ = source.structure_generation();
  dirty_cell_slots_.clear();
  dirty_boundary_cells_.clear();
  dirty_corner_sets_.clear();
  ++generation_;
}

/// Which bricks, of this level, changed since the last update, and which boundary cells.
void ResidentSmoke::find_changes(const smoke::SmokeVolume& source) {
  changed_bricks_.clear();
  everything_changed_ = false;
  const bool same_structure = source.structure_generation() == source_generation_;
  if (source.revision() == source_revision_ && same_structure) return;
  // What is dirty is only that since the revision before. A brick that is gone has no slot to be dirty by.
  everything_changed_ = source.revision() != source_revision_ + 1 || (level_ > 0 && !same_structure);
  if (!same_structure) {
    begin();
    ++generation_;
  }
  if (everything_changed_) {
    begin();
    dirty_boundary_cells_.assign(1, {0, static_cast<std::uint32_t>(source.boundary_cells().size())});
    dirty_corner_sets_.assign(1, {0, static_cast<std::uint32_t>(source.corner_sets().size())});
    return;
  }
  const auto add = [&](std::uint32_t slot) {
    const glm::ivec3 brick = source.brick_of(slot);
    if (level_ == 0) return changed_bricks_.push_back(brick);
    const Box<int> voxels{shared::kBrickVoxels * brick, shared::kBrickVoxels * (brick + 1)};
    const glm::ivec3 middle = brick >> level_;
    for_each_in(Box<int>{middle - 1, middle + 2}, [&](glm::ivec3 coarse) {
      if (!intersection(voxels, taken_from(level_, coarse)).empty()) changed_bricks_.push_back(coarse);
    });
  };
  for (const std::uint32_t slot : source.dirty_slots()) add(slot);
  for (const std::uint32_t slot : source.dirty_cell_slots()) add(slot);
  sort_once(changed_bricks_);
  const auto boundary = source.dirty_boundary_cells(), corners = source.dirty_corner_sets();
  if (level_ > 0 || (boundary.empty() && corners.empty())) return;
  begin();
  dirty_boundary_cells_.assign(boundary.begin(), boundary.end());
  dirty_corner_sets_.assign(corners.begin(), corners.end());
}

bool ResidentSmoke::has_changed(glm::ivec3 brick) const {
  return everything_changed_ ||
         std::binary_search(changed_bricks_.begin(), changed_bricks_.end(), brick, before);
}

void ResidentSmoke::begin() {
  if (updating_) return;
  updating_ = true;
  held_.begin_update();
  dirty_cell_slots_.clear();
  dirty_boundary_cells_.clear();
  dirty_corner_sets_.clear();
}

void ResidentSmoke::release(std::uint32_t slot) {
  begin();
  held_.release(slot);
  dirty_cell_slots_.push_back(slot);
}

void ResidentSmoke::write(std::uint32_t slot) {
  begin();
  const glm::ivec3 brick = held_.brick_of(slot);
  const auto texels = held_.texels<Texel>(kDensityChannel, slot);
  if (level_ > 0) {
    fill_coarse_brick(*source_, level_, brick, texels);
  } else {
    const auto own = source_->texels(source_->slot_at(brick));
    std::copy(own.begin(), own.end(), texels.begin());
  }
  held_.mark_dirty(kDensityChannel, slot);
  dirty_cell_slots_.push_back(slot);
}

/// Drops what is gone, and what changed and is not wanted; writes what changed and is.
void ResidentSmoke::follow_changes() {
  if (!everything_changed_ && changed_bricks_.empty() &&
      source_->structure_generation() == source_generation_)
    return;
  for (std::uint32_t slot = held_.slot_count(); slot-- > 0;) {
    if (slot >= held_.slot_count() || !held_.in_use(slot)) continue;
    const glm::ivec3 brick = held_.brick_of(slot);
    const bool is_gone = level_ == 0 && source_->slot_at(brick) == kNoSlot;
    if (!is_gone && !has_changed(brick)) continue;
    if (is_gone || last_frame_[slot] != frames_)
      release(slot);
    else
      write(slot);
  }
}

/// Releases what was not wanted for the longest time where the atlas would have to grow for it.
void ResidentSmoke::make_room(std::size_t arriving, std::size_t wanted, std::size_t most, Allocator memory) {
  if (arriving == 0) return;
  FrameVector<std::pair<std::uint64_t, std::uint32_t>> unwanted(memory);  // last frame, slot
  std::size_t in_use = 0;
  for (std::uint32_t slot = 0; slot < held_.slot_count(); ++slot) {
    if (!held_.in_use(slot)) continue;
    ++in_use;
    if (last_frame_[slot] != frames_) unwanted.push_back({last_frame_[slot], slot});
  }
  const std::size_t room =
      std::min(std::max<std::size_t>(room_of(held_.layout().bricks.atlas_bricks), wanted), most);
  if (in_use + arriving <= room) return;
  std::sort(unwanted.begin(), unwanted.end());
  const std::size_t count = std::min(unwanted.size(), in_use + arriving - room);
  for (std::size_t i = 0; i < count; ++i) release(unwanted[i].second);
}

void ResidentSmoke::end() {
  source_id_ = source_->id();
  source_revision_ = source_->revision();
  source_generation_ = source_->structure_generation();
  if (!updating_) return;
  const float scale = 1.0f / static_cast<float>(1 << level_);
  held_.set_bounds(scale * source_->layout().bounds_min, scale * source_->layout().bounds_max);
  const std::uint64_t structure = held_.structure_generation();
  held_.end_update();
  if (held_.structure_generation() != structure) ++generation_;
  std::erase_if(dirty_cell_slots_, [&](std::uint32_t slot) { return slot >= held_.slot_count(); });
  std::sort(dirty_cell_slots_.begin(), dirty_cell_slots_.end());
  dirty_cell_slots_.erase(std::unique(dirty_cell_slots_.begin(), dirty_cell_slots_.end()),
                          dirty_cell_slots_.end());
  updating_ = false;
}

SmokeVisibility ResidentSmoke::update(const Request& request, const SmokeVisibility& visible,
                                      Allocator memory) {
  source_ = &request.volume;
  ++frames_;
  int level = 0;
  const bool was_missing = is_missing_;
  FrameVector<glm::ivec3> in_view = choose_level(request, visible, level, memory);
  const Wanted wanted = wanted_at(level, request, visible, std::move(in_view));
  is_missing_ = wanted.is_limited;
  wanted_count_ = static_cast<std::uint32_t>(wanted.bricks.size());
  const std::uint64_t generation = generation_;
  const bool was_interrupted = updating_;  // Memory ran out halfway through an update.
  if (was_interrupted || source_->id() != source_id_ || level != level_ ||
      room_of(held_.layout().bricks.atlas_bricks) > request.most_bricks)
    restart(*source_, level,
            room_of(request.atlas_bricks) > request.most_bricks ? volume::grown_atlas({}, request.most_bricks)
                                                                : request.atlas_bricks);

  // What stays.
  FrameVector<glm::ivec3> arriving(memory);
  for (const glm::ivec3 brick : wanted.bricks) {
    if (const std::uint32_t slot = held_.slot_at(brick); slot != kNoSlot)
      last_frame_[slot] = frames_;
    else
      arriving.push_back(brick);
  }
  find_changes(*source_);
  follow_changes();

  // What comes.
  make_room(arriving.size(), wanted.bricks.size(), request.most_bricks, memory);
  for (const glm::ivec3 brick : arriving) {
    begin();
    const std::uint32_t slot = held_.acquire(brick);
    if (last_frame_.size() <= slot) last_frame_.resize(std::size_t{slot} + 1);
    last_frame_[slot] = frames_;
    write(slot);
  }
  end();
  shows_other_ = (was_missing || is_missing_) && generation_ != generation;

  SmokeVisibility held{FrameVector<std::uint32_t>(memory), 0, visible.visible_bounds, visible.caster_bounds};
  FrameVector<SlotRole> roles(held_.slot_count(), SlotRole::none, memory);
  for (std::size_t i = 0; i < wanted.required; ++i)
    roles[held_.slot_at(wanted.bricks[i])] = i < wanted.visible ? SlotRole::visible : SlotRole::caster;
  set_slots(held, roles);
  const float scale = 1.0f / static_cast<float>(1 << level_);
  for (Box<float>* box : {&held.visible_bounds, &held.caster_bounds})
    *box = {scale * box->low, scale * box->high};
  return held;
}

std::span<const std::uint32_t> ResidentSmoke::cells(std::uint32_t slot) const {
  if (level_ > 0 || !held_.in_use(slot)) return kNoCells;
  const std::uint32_t own = source_->slot_at(held_.brick_of(slot));
  return own == kNoSlot ? std::span<const std::uint32_t>(kNoCells) : source_->cells(own);
}

std::span<const shared::BoundaryCell> ResidentSmoke::boundary_cells() const {
  return level_ > 0 || !source_ ? std::span<const shared::BoundaryCell>() : source_->boundary_cells();
}

std::span<const glm::uvec2> ResidentSmoke::corner_sets() const {
  return level_ > 0 || !source_ ? std::span<const glm::uvec2>() : source_->corner_sets();
}

}  // namespace brume::planning
