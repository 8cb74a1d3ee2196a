// A sparse volume on the device: its page table, the brick of each slot, and a 3D image for each channel,
// uploaded where they changed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gpu/recorder.hpp"
#include "volume/sparse_volume.hpp"

namespace brume::passes {

/// Follows a volume; another volume than before is uploaded as a whole. An image holds the bricks of all
/// slots: texel t of slot s is at shared::atlas_first_texel(atlas_bricks, s) + t.
class BrickAtlas {
 public:
  /// What a record uploaded.
  enum class Upload { nothing, changes, everything };

  /// `channels` are the formats of the volume's channels, in order, with texels of the same size in bytes;
  /// `derived` those of further images of the same layout, which passes write and nothing is uploaded to. The
  /// images have room for one brick until the first `reserve`. Throws resource_limit.
  BrickAtlas(gpu::Context& context, std::span<const VkFormat> channels,
             std::span<const VkFormat> derived = {});
  BrickAtlas(const BrickAtlas&) = delete;
  BrickAtlas& operator=(const BrickAtlas&) = delete;

  /// Makes room for what the volume holds. Growth replaces images, derived ones too: their content is
  /// undefined then. Not between the begin and the end of a recording, and only when the device is done with
  /// what it recorded before. Throws resource_limit when the device's 3D textures cannot hold the bricks.
  void reserve(const volume::SparseVolume& volume);
  /// Uploads what changed since the last record; everything when the volume has had more than one update
  /// since or `reserve` replaced a resource. The volume must be as `reserve` saw it.
  Upload record(gpu::Recorder& recorder, const volume::SparseVolume& volume);

  // References stay valid; the resources that they refer to are replaced by `reserve`.
  /// The root of the page table, then its nodes (shared/smoke_volume.h).
  const gpu::Buffer& pages() const { return pages_; }
  /// Per slot its brick, an ivec3 [bricks].
  const gpu::Buffer& slot_bricks() const { return slot_bricks_; }
  const gpu::Image& channel(volume::ChannelId channel) const {
    return channels_[static_cast<std::size_t>(channel)];
  }
  /// By position in the constructor's list.
  const gpu::Image& derived(std::size_t i) const { return derived_[i]; }

 private:
  void make_images(glm::ivec3 bricks);
  void record_pages(gpu::Recorder& recorder, const volume::PageTable& pages, bool all);
  void record_bricks(gpu::Recorder& recorder, const volume::SparseVolume& volume,
                     std::span<const std::uint32_t> slots);
  void record_texels(gpu::Recorder& recorder, const volume::SparseVolume& volume, volume::ChannelId channel,
                     std::span<const std::uint32_t> slots);

  gpu::Context& context_;
  std::vector<VkFormat> channel_formats_, derived_formats_;
  gpu::Buffer pages_, slot_bricks_;
  std::vector<gpu::Image> channels_, derived_;  // as many as formats, always
  glm::ivec3 atlas_bricks_{0};
  const volume::SparseVolume* volume_ = nullptr;  // that `reserve` saw last
  std::uint64_t reserved_generation_ = 0, uploaded_revision_ = 0;
  std::size_t root_entries_ = 0;
  bool everything_ = true;  // a resource is new and empty
};

/// Slots one after the other.
struct SlotRun {
  std::uint32_t first = 0, count = 0;
};
/// The runs of slots in rising order: each can be uploaded at once.
std::vector<SlotRun> runs_of(std::span<const std::uint32_t> slots);
/// 0 to slot_count - 1.
std::vector<std::uint32_t> all_slots(std::uint32_t slot_count);

}  // namespace brume::passes
