// A sparse volume: bricks of 8^3 voxels, found through a page table, with any number of channels of texels,
// and a record of what each update changed.
//
//   brick (voxel / 8, rounded down)  --page table-->  slot  -->  10^3 texels in every channel
//
// A brick's texels are its 8^3 voxels and an apron of one texel around them, so that trilinear filtering
// never reads another brick. A slot is also the brick's place in the atlases on the device
// (shaders/shared/volume.h). What the texels mean is up to the writer.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "shared/volume.h"
#include "volume/page_table.hpp"

namespace brume::volume {

/// What a channel holds in each texel.
struct ChannelFormat {
  std::uint32_t bytes_per_texel = 0;  ///< > 0.
};

/// A channel, by its position in SparseVolumeInfo::channels.
enum class ChannelId : std::uint32_t {};

/// Bricks per axis of the largest atlas; the device may hold less.
inline constexpr int kMaxAtlasBricks = 256;
inline constexpr std::uint32_t kMaxAtlasSlots = 256u * 256u * 256u;

struct SparseVolumeInfo {
  glm::vec3 origin_world{0};  ///< Low corner of voxel (0, 0, 0) [m].
  float voxel_size = 1;       ///< [m]
  std::vector<ChannelFormat> channels;
  std::uint32_t max_bricks = kMaxAtlasSlots;  ///< In [1, kMaxAtlasSlots].
  glm::ivec3 atlas_bricks{0};  ///< Size of the atlas from the start: 0, or as grown_atlas gives it.
};

/// A brick whose texels, apron included, are all this half float.
struct UniformBrick {
  glm::ivec3 at{0};
  std::uint16_t texel = 0;
};

/// The slots of the 3^3 bricks around one, itself in the middle: x + 3 y + 9 z of brick - at + 1; kNoSlot
/// where there is no brick.
using NeighbourSlots = std::array<std::uint32_t, 27>;

/// All changes happen between begin_update and end_update. "The last update" is the one that ended last;
/// while one is going on, only the page table, slots and texels can be read.
class SparseVolume {
 public:
  static constexpr std::uint32_t kNoSlot = PageTable::kNoSlot;

  static constexpr std::size_t kMaxBoxes = 4;

  explicit SparseVolume(const SparseVolumeInfo& info);

  /// No other volume of the process has this number, as long as it runs.
  std::uint64_t id() const { return id_; }

  /// Clears the dirty slots and the changes of the page table.
  void begin_update();
  /// Gives the brick the lowest free slot. Its texels are 0 and dirty in every channel. The brick must have
  /// none. Throws resource_limit, with nothing changed, when the volume has max_bricks bricks.
  std::uint32_t acquire(glm::ivec3 brick);
  /// Makes a brick that does not exist uniform: without a slot, all texels of its only channel this half
  /// float. It remains so.
  void set_uniform(glm::ivec3 brick, std::uint16_t texel);
  /// Takes the slot from its brick. Its texels become 0 and dirty in every channel; slot_count() falls when
  /// no slot above it is in use.
  void release(std::uint32_t slot);
  /// Texels of the slot change in this update. Also after end_update, by a writer that computes texels late;
  /// sort_dirty then has to follow before anyone reads what is dirty.
  void mark_dirty(ChannelId channel, std::uint32_t slot);
  void sort_dirty(ChannelId channel) { channels_[index(channel)].dirty.sort(slot_count()); }
  /// Where anything can be [voxel space]: layout().bounds_min and bounds_max, from the end of the update on.
  void set_bounds(glm::vec3 low, glm::vec3 high);
  /// Takes bounds and boxes from another volume, from the end of the update on: this one is a part of it.
  void set_extent(const SparseVolume& whole);
  /// Publishes layout, dirty slots and revision. The atlas grows to slot_count() bricks and never shrinks.
  void end_update();

  /// The slot of a brick, or kNoSlot.
  std::uint32_t slot_at(glm::ivec3 brick) const { return pages_.at(brick); }
  /// In the order in which they were set.
  std::span<const UniformBrick> uniform_bricks() const { return uniform_bricks_; }
  /// The texel of a uniform brick.
  std::optional<std::uint16_t> uniform_at(glm::ivec3 brick) const { return pages_.uniform_at(brick); }
  NeighbourSlots slots_around(glm::ivec3 brick) const;
  /// One past the highest slot in use. Lower ones may be free.
  std::uint32_t slot_count() const { return static_cast<std::uint32_t>(slots_.size()); }
  /// Whether a brick has the slot, which is below slot_count().
  bool in_use(std::uint32_t slot) const { return slots_[slot].in_use; }
  /// The brick of a slot; (0, 0, 0) of a free one.
  glm::ivec3 brick_of(std::uint32_t slot) const { return slots_[slot].brick; }
  const PageTable& pages() const { return pages_; }

  std::uint32_t channel_count() const { return static_cast<std::uint32_t>(channels_.size()); }
  ChannelFormat format(ChannelId channel) const { return channels_[index(channel)].format; }
  /// The texels of a slot: kTexelsPerBrick of the channel's size, x + 10 (y + 10 z), where texel (1, 1, 1) is
  /// voxel 8 brick. All 0 in a free slot. The memory stays where it is as long as the slot is below
  /// slot_count().
  std::span<std::byte> channel(ChannelId channel, std::uint32_t slot) {
    return {texels_of(channel, slot), brick_bytes(channel)};
  }
  std::span<const std::byte> channel(ChannelId channel, std::uint32_t slot) const {
    return {texels_of(channel, slot), brick_bytes(channel)};
  }
  /// The same as values of a trivial type of the channel's size, whose zero bytes are a value.
  template <typename Texel>
  std::span<Texel, shared::kTexelsPerBrick> texels(ChannelId channel, std::uint32_t slot) {
    check_size(channel, sizeof(Texel));
    return std::span<Texel, shared::kTexelsPerBrick>(reinterpret_cast<Texel*>(texels_of(channel, slot)),
                                                     shared::kTexelsPerBrick);
  }
  template <typename Texel>
  std::span<const Texel, shared::kTexelsPerBrick> texels(ChannelId channel, std::uint32_t slot) const {
    check_size(channel, sizeof(Texel));
    return std::span<const Texel, shared::kTexelsPerBrick>(
        reinterpret_cast<const Texel*>(texels_of(channel, slot)), shared::kTexelsPerBrick);
  }

  /// The layout after the last update, in an atlas that holds this volume alone.
  const shared::VolumeLayout& layout() const { return layout_; }
  /// Boxes that nothing lies outside of after the last update, at most kMaxBoxes [voxel space]: far smaller
  /// together than the bounds where parts of the volume are far from each other.
  std::span<const Box<float>> boxes() const { return boxes_; }
  /// Slots below slot_count() whose texels the last update marked, acquired or released, in rising order.
  std::span<const std::uint32_t> dirty(ChannelId channel) const {
    return channels_[index(channel)].dirty.slots();
  }
  /// Slots below slot_count() that the last update acquired or released, in rising order.
  std::span<const std::uint32_t> dirty_bricks() const { return dirty_bricks_.slots(); }
  /// The number of updates. What is dirty is all that differs from revision() - 1.
  std::uint64_t revision() const { return revision_; }
  /// The number of updates that acquired or released a slot. In between pages, brick_of, slot_count and the
  /// atlas's size stay as they are.
  std::uint64_t structure_generation() const { return structure_generation_; }

  /// Bytes of memory held.
  std::uint64_t bytes() const;

 private:
  /// Slots, each once.
  class SlotSet {
   public:
    void resize(std::size_t slot_count) { has_.resize(slot_count); }
    void insert(std::uint32_t slot);
    void clear();
    /// Puts them in order, without `slot_count` and above.
    void sort(std::uint32_t slot_count);
    std::span<const std::uint32_t> slots() const { return slots_; }

   private:
    std::vector<std::uint32_t> slots_;
    std::vector<bool> has_;  // by slot
  };
  struct Channel {
    ChannelFormat format;
    std::vector<std::unique_ptr<std::byte[]>> texels;  // by slot
    SlotSet dirty;
  };
  struct Slot {
    glm::ivec3 brick{0};
    bool in_use = false;
  };

  static std::size_t index(ChannelId channel) { return static_cast<std::size_t>(channel); }
  std::size_t brick_bytes(ChannelId channel) const {
    return std::size_t{format(channel).bytes_per_texel} * shared::kTexelsPerBrick;
  }
  std::byte* texels_of(ChannelId channel, std::uint32_t slot) const {
    return channels_[index(channel)].texels[slot].get();
  }
  void check_size(ChannelId channel, std::size_t bytes) const {
    BRUME_ASSERT(bytes == format(channel).bytes_per_texel, std::to_string(bytes));
  }
  void resize(std::size_t slot_count);
  void mark_everything(std::uint32_t slot);
  void find_boxes();

  std::uint64_t id_;
  std::uint32_t max_bricks_;
  shared::VolumeLayout layout_{};
  glm::vec3 bounds_min_{0}, bounds_max_{0};
  std::vector<Box<int>> node_boxes_;
  std::vector<Box<float>> boxes_;
  std::vector<Box<float>> extent_;  ///< Boxes of what this is a part of; empty: of nothing.
  PageTable pages_;
  std::vector<Slot> slots_;
  std::set<std::uint32_t> free_slots_;  // slots that no brick has
  std::vector<Channel> channels_;
  std::vector<UniformBrick> uniform_bricks_;
  SlotSet dirty_bricks_;
  bool updating_ = false, structure_changed_ = false;
  std::uint64_t revision_ = 0, structure_generation_ = 0;
};

/// Bricks per axis of an atlas for `slots` bricks, powers of two, at least `bricks`: the shortest axis
/// doubles, from 4 on, until there is room. Throws resource_limit for more than kMaxAtlasSlots.
glm::ivec3 grown_atlas(glm::ivec3 bricks, std::uint64_t slots);

/// Sets the size of the atlas that a layout is in: bricks per axis, powers of two along x and y.
void set_atlas(shared::BrickLayout& layout, glm::ivec3 bricks);

}  // namespace brume::volume
