#include "volume/sparse_volume.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <string>

namespace brume::volume {
namespace {

[[noreturn]] void throw_too_many_bricks(std::uint64_t limit) {
  throw Error(ErrorCode::resource_limit,
              "a volume of more than " + std::to_string(limit) + " bricks of 8^3 voxels; use larger voxels");
}

/// A number that no volume had before.
std::uint64_t next_id() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

}  // namespace

void SparseVolume::SlotSet::insert(std::uint32_t slot) {
  if (has_[slot]) return;
  has_[slot] = true;
  slots_.push_back(slot);
}

void SparseVolume::SlotSet::clear() {
  for (const std::uint32_t slot : slots_)
    if (slot < has_.size()) has_[slot] = false;
  slots_.clear();
}

void SparseVolume::SlotSet::sort(std::uint32_t slot_count) {
  std::erase_if(slots_, [&](std::uint32_t slot) { return slot >= slot_count; });
  std::sort(slots_.begin(), slots_.end());
  // A slot that was released at the end and acquired again is there twice.
  slots_.erase(std::unique(slots_.begin(), slots_.end()), slots_.end());
}

SparseVolume::SparseVolume(const SparseVolumeInfo& info) : id_(next_id()), max_bricks_(info.max_bricks) {
  BRUME_ASSERT(max_bricks_ > 0 && max_bricks_ <= kMaxAtlasSlots, std::to_string(max_bricks_));
  layout_.origin_world = info.origin_world;
  layout_.voxel_size = info.voxel_size;
  layout_.voxels_per_metre = 1 / info.voxel_size;
  layout_.bricks.atlas_bricks = info.atlas_bricks;
  for (const ChannelFormat& format : info.channels) {
    BRUME_ASSERT(format.bytes_per_texel > 0, std::to_string(channels_.size()));
    channels_.emplace_back().format = format;
  }
}

void SparseVolume::begin_update() {
  BRUME_ASSERT(!updating_, "the update before has not ended");
  updating_ = true;
  structure_changed_ = false;
  pages_.clear_changes();
  for (Channel& channel : channels_) channel.dirty.clear();
  dirty_bricks_.clear();
}

std::uint32_t SparseVolume::acquire(glm::ivec3 brick) {
  BRUME_ASSERT(updating_ && slot_at(brick) == kNoSlot && !uniform_at(brick),
               "outside of an update, or the brick exists");
  std::uint32_t slot = slot_count();
  if (free_slots_.empty()) {
    if (slot == max_bricks_) throw_too_many_bricks(max_bricks_);
    resize(slots_.size() + 1);
  } else {
    slot = *free_slots_.begin();
    free_slots_.erase(free_slots_.begin());
  }
  slots_[slot] = {brick, true};
  pages_.set(brick, slot);
  mark_everything(slot);
  return slot;
}

void SparseVolume::set_uniform(glm::ivec3 brick, std::uint16_t texel) {
  BRUME_ASSERT(updating_ && slot_at(brick) == kNoSlot && !uniform_at(brick),
               "outside of an update, or the brick exists");
  BRUME_ASSERT(channels_.size() == 1 && channels_[0].format.bytes_per_texel == sizeof texel,
               "one half float");
  pages_.set_uniform(brick, texel);
  uniform_bricks_.push_back({brick, texel});
  structure_changed_ = true;
}

void SparseVolume::release(std::uint32_t slot) {
  BRUME_ASSERT(updating_ && slot < slot_count() && in_use(slot), std::to_string(slot));
  pages_.set(slots_[slot].brick, kNoSlot);
  slots_[slot] = {};
  for (std::uint32_t i = 0; i < channel_count(); ++i)
    std::fill_n(texels_of(ChannelId{i}, slot), brick_bytes(ChannelId{i}), std::byte{0});
  mark_everything(slot);
  free_slots_.insert(slot);

  std::size_t in_use_end = slots_.size();
  while (in_use_end > 0 && !slots_[in_use_end - 1].in_use) --in_use_end;
  free_slots_.erase(free_slots_.lower_bound(static_cast<std::uint32_t>(in_use_end)), free_slots_.end());
  if (in_use_end < slots_.size()) resize(in_use_end);
}

void SparseVolume::resize(std::size_t slot_count) {
  // Slots come last: where memory runs out, none lacks its texels.
  for (Channel& channel : channels_) {
    while (channel.texels.size() < slot_count)
      channel.texels.push_back(std::make_unique<std::byte[]>(std::size_t{channel.format.bytes_per_texel} *
                                                             shared::kTexelsPerBrick));
    channel.texels.resize(slot_count);
    channel.dirty.resize(slot_count);
  }
  dirty_bricks_.resize(slot_count);
  slots_.resize(slot_count);
}

/// Marks that the slot changed hands.
void SparseVolume::mark_everything(std::uint32_t slot) {
  structure_changed_ = true;
  dirty_bricks_.insert(slot);
  for (Channel& channel : channels_) channel.dirty.insert(slot);
}

void SparseVolume::mark_dirty(ChannelId channel, std::uint32_t slot) {
  BRUME_ASSERT(slot < slot_count(), std::to_string(slot));
  channels_[index(channel)].dirty.insert(slot);
}

void SparseVolume::set_bounds(glm::vec3 low, glm::vec3 high) {
  bounds_min_ = low;
  bounds_max_ = high;
}

void SparseVolume::set_extent(const SparseVolume& whole) {
  set_bounds(whole.layout().bounds_min, whole.layout().bounds_max);
  extent_.assign(whole.boxes().begin(), whole.boxes().end());
}

void SparseVolume::end_update() {
  BRUME_ASSERT(updating_, "no update has begun");
  layout_.bounds_min = bounds_min_;
  layout_.bounds_max = bounds_max_;
  if (structure_changed_) {
    if (pages_.root_changed()) pages_.find_distances();
    layout_.bricks.window_origin = pages_.origin();
    layout_.bricks.window_size = pages_.size();
    if (slot_count() > 0) set_atlas(layout_.bricks, grown_atlas(layout_.bricks.atlas_bricks, slot_count()));
    layout_.texels_per_metre = layout_.bricks.atlas_texel / layout_.voxel_size;
    ++structure_generation_;
  }
  find_boxes();
  for (Channel& channel : channels_) channel.dirty.sort(slot_count());
  dirty_bricks_.sort(slot_count());
  ++revision_;
  updating_ = false;
}

void SparseVolume::find_boxes() {
  if (structure_changed_ && pages_.root_changed()) node_boxes_ = pages_.groups(kMaxBoxes);
  constexpr int kNodeVoxels = shared::kNodeBricks * shared::kBrickVoxels;
  boxes_ = extent_;
  if (!extent_.empty()) return;
  for (const Box<int>& nodes : node_boxes_)
    boxes_.push_back(intersection({glm::vec3(kNodeVoxels * nodes.low), glm::vec3(kNodeVoxels * nodes.high)},
                                  Box<float>{layout_.bounds_min, layout_.bounds_max}));
}

NeighbourSlots SparseVolume::slots_around(glm::ivec3 brick) const {
  NeighbourSlots slots;
  for (int i = 0; i < 27; ++i)
    slots[static_cast<std::size_t>(i)] = slot_at(brick + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1);
  return slots;
}

std::uint64_t SparseVolume::bytes() const {
  std::uint64_t sum =
      slots_.capacity() * sizeof(Slot) + pages_.root().size_bytes() + pages_.nodes().size_bytes();
  sum += uniform_bricks_.capacity() * sizeof(UniformBrick);
  for (const Channel& channel : channels_)
    sum += channel.texels.size() *
           (sizeof(void*) + std::uint64_t{channel.format.bytes_per_texel} * shared::kTexelsPerBrick);
  return sum;
}

glm::ivec3 grown_atlas(glm::ivec3 bricks, std::uint64_t slots) {
  if (slots > kMaxAtlasSlots) throw_too_many_bricks(kMaxAtlasSlots);
  if (bricks.x == 0) bricks = glm::ivec3(4);
  const auto room = [&] {
    const glm::u64vec3 b(bricks);
    return b.x * b.y * b.z;
  };
  while (room() < slots) {
    const int axis = bricks.x <= bricks.y && bricks.x <= bricks.z ? 0 : bricks.y <= bricks.z ? 1 : 2;
    bricks[axis] *= 2;
  }
  return bricks;
}

void set_atlas(shared::BrickLayout& layout, glm::ivec3 bricks) {
  const glm::uvec2 rows(bricks);
  BRUME_ASSERT(std::has_single_bit(rows.x) && std::has_single_bit(rows.y),
               std::to_string(rows.x) + " x " + std::to_string(rows.y));
  layout.atlas_bricks = bricks;
  layout.atlas_texel = 1.0f / glm::vec3(bricks * shared::kBrickTexels);
  layout.atlas_bits_x = static_cast<std::uint32_t>(std::countr_zero(rows.x));
  layout.atlas_bits_y = static_cast<std::uint32_t>(std::countr_zero(rows.y));
}

}  // namespace brume::volume
