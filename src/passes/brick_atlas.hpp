// Sparse volumes on the device: their page tables, the brick of each slot, and a 3D image for each channel,
// uploaded where they changed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gpu/recorder.hpp"
#include "volume/sparse_volume.hpp"

namespace brume::passes {

/// Any number of volumes with the same channels.
using VolumeList = std::span<const volume::SparseVolume* const>;

/// What a record uploads of a volume whose bricks come over several frames.
struct StreamedBricks {
  bool streamed = false;                      ///< False: as any other volume.
  bool pages = false;                         ///< Its page table.
  std::span<const std::uint32_t> slots = {};  ///< Rising.
};

/// A volume of fewer slots has up to as many in a tight atlas; one of more up to an eighth more than it
/// holds.
inline constexpr std::uint32_t kVolumeSlotStep = 1u << 9;

/// Bricks per axis of an atlas for `slots` bricks, powers of two along x and y: as volume::grown_atlas up to
/// 256 MiB of half floats, then with less than a layer unused. None is longer than `most` bricks. Throws
/// resource_limit for more than fit, which are those beyond most_slots(most).
glm::ivec3 tight_atlas(std::uint64_t slots, int most);
std::uint64_t most_slots(int most);

/// Follows a list of volumes; one that was not in the list before is uploaded as a whole. The images hold the
/// bricks of all slots of all volumes, where the `layout` of each says (shared/volume.h).
class BrickAtlas {
 public:
  /// What a record uploaded.
  enum class Upload { nothing, changes, everything };

  /// `channels` are the formats of the volumes' channels, in order, with texels of the same size in bytes;
  /// `derived` the formats of further images of the same layout, which passes write and nothing is uploaded
  /// to. The images have room for `room` bricks until the first `reserve`. `tight`: volumes do not grow, and
  /// images are as small as tight_atlas makes them. Throws resource_limit.
  BrickAtlas(gpu::Context& context, std::span<const VkFormat> channels,
             std::span<const VkFormat> derived = {}, bool tight = false, std::uint32_t room = 1);
  BrickAtlas(const BrickAtlas&) = delete;
  BrickAtlas& operator=(const BrickAtlas&) = delete;

  /// Makes room for what the volumes hold. Growth replaces images, derived ones too: their content is
  /// undefined then. A volume that comes, goes or grows may move volumes behind it in the list, which are
  /// then uploaded again. To be called when the device is done with what it recorded before, and not while
  /// recording. Throws resource_limit when the device's 3D textures cannot hold the bricks; what was uploaded
  /// counts as lost then.
  void reserve(VolumeList volumes);
  /// Uploads what changed since the last record; all of a volume that has had more than one update since, or
  /// that `reserve` moved. The volumes must be as `reserve` saw them. Returns the most that it
  /// uploaded of any volume. `streams`: by position in the list; empty: no volume is streamed.
  Upload record(gpu::Recorder& recorder, VolumeList volumes, std::span<const StreamedBricks> streams = {});
  /// Whether nothing of a volume is on the device since the last `reserve`.
  bool is_missing(std::size_t volume) const { return entries_.get(context_)[volume].everything; }

  /// Where a volume of the list is, by its position. Alone in an atlas it is where its own layout says.
  const shared::BrickLayout& layout(std::size_t volume) const {
    return entries_.get(context_)[volume].layout;
  }

  /// Images of another size, as volume::grown_atlas returns it, without any volume.
  void clear(glm::ivec3 bricks);
  /// Bricks per axis of its images.
  glm::ivec3 atlas_bricks() const { return atlas_bricks_; }

  // References stay valid; the resources that they refer to are replaced by `reserve`.
  /// Page tables of all volumes: the root of each, then its nodes (shared/volume.h).
  const gpu::Buffer& pages() const { return pages_; }
  /// Per slot its brick, an ivec3 [bricks].
  const gpu::Buffer& slot_bricks() const { return slot_bricks_; }
  const gpu::Image& channel(volume::ChannelId channel) const {
    return channels_[static_cast<std::size_t>(channel)];
  }
  /// By position in the constructor's list.
  const gpu::Image& derived(std::size_t i) const { return derived_[i]; }

 private:
  /// A volume of the list.
  struct Entry {
    std::uint64_t id = 0, reserved_generation = 0, uploaded_revision = 0;
    shared::BrickLayout layout{};
    std::uint32_t pages = 0;  // room in the page buffer
    std::uint32_t slots = 0;  // room in the atlas
    std::size_t root_entries = 0;
    bool everything = true;  // nothing of it is on the device
  };

  bool is_reserved(VolumeList volumes) const;
  std::vector<Entry> place(VolumeList volumes) const;
  void make_images(glm::ivec3 bricks);
  glm::ivec3 atlas_for(std::uint64_t slots) const;
  Upload record_volume(gpu::Recorder& recorder, const volume::SparseVolume& volume, Entry& entry);
  void record_stream(gpu::Recorder& recorder, const volume::SparseVolume& volume,
                     const StreamedBricks& stream, Entry& entry);
  void record_pages(gpu::Recorder& recorder, const volume::PageTable& pages, bool all, Entry& entry);
  void record_bricks(gpu::Recorder& recorder, const volume::SparseVolume& volume,
                     std::span<const std::uint32_t> slots, const Entry& entry);
  void record_texels(gpu::Recorder& recorder, const volume::SparseVolume& volume, volume::ChannelId channel,
                     std::span<const std::uint32_t> slots, const Entry& entry);

  gpu::Context& context_;
  std::vector<VkFormat> channel_formats_, derived_formats_;
  bool tight_;
  gpu::Buffer pages_, slot_bricks_;
  std::vector<gpu::Image> channels_, derived_;  // as many as formats, always
  glm::ivec3 atlas_bricks_{0};
  gpu::Recorded<std::vector<Entry>> entries_;  // by position in the list that `reserve` saw last
};

/// Slots one after the other.
struct SlotRun {
  std::uint32_t first = 0, count = 0;
};
/// Visits the runs of slots in rising order: each can be uploaded at once.
template <typename Visit>
void for_each_run(std::span<const std::uint32_t> slots, Visit&& visit) {
  for (std::size_t first = 0; first < slots.size();) {
    std::size_t end = first + 1;
    while (end < slots.size() && slots[end] == slots[end - 1] + 1) ++end;
    visit(SlotRun{slots[first], static_cast<std::uint32_t>(end - first)});
    first = end;
  }
}
/// 0 to slot_count - 1.
FrameVector<std::uint32_t> all_slots(std::uint32_t slot_count, Allocator memory);

}  // namespace brume::passes
