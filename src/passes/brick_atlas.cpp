#include "passes/brick_atlas.hpp"

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

#include "core/error.hpp"

namespace brume::passes {
namespace {

gpu::Image make_image(gpu::Context& context, glm::ivec3 bricks, VkFormat format, VkImageUsageFlags usage) {
  const glm::uvec3 texels = glm::uvec3(bricks) * static_cast<std::uint32_t>(shared::kBrickTexels);
  const std::uint32_t limit = context.limits().maxImageDimension3D;
  if (texels.x > limit || texels.y > limit || texels.z > limit) {
    throw Error(
        ErrorCode::resource_limit,
        "a volume needs more bricks than the device's 3D textures hold; use larger voxels or less smoke");
  }
  return gpu::Image(context, gpu::sampled_image_3d(texels, format, usage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT));
}

/// A multiple of an eighth of a power of two, so that the next frame of a sequence takes as many in most
/// cases.
std::uint64_t rounded_slots(std::uint64_t slots) {
  const std::uint64_t step = std::max<std::uint64_t>(std::bit_floor(slots) / 8, 1);
  return (slots + step - 1) / step * step;
}

/// Slots of a volume in the atlas: with room to grow, or not.
std::uint32_t room_of(const volume::SparseVolume& volume, bool tight) {
  const glm::uvec3 room(volume.layout().bricks.atlas_bricks);
  const std::uint32_t slots = room.x * room.y * room.z;
  if (!tight || slots <= kVolumeSlotStep) return slots;
  return static_cast<std::uint32_t>(
      std::max<std::uint64_t>(rounded_slots(volume.slot_count()), kVolumeSlotStep));
}

}  // namespace

std::uint64_t most_slots(int most) {
  const std::uint64_t edge = std::bit_floor(static_cast<std::uint64_t>(most));
  return edge * edge * static_cast<std::uint64_t>(most);
}

glm::ivec3 tight_atlas(std::uint64_t slots, int most) {
  constexpr std::uint64_t kSmall = 1u << 17;
  if (slots > most_slots(most))
    throw Error(ErrorCode::resource_limit,
                "volumes of " + std::to_string(slots) +
                    " bricks of 8^3 voxels are more than the device's 3D textures hold");
  const glm::ivec3 grown = slots <= kSmall ? volume::grown_atlas({}, slots) : glm::ivec3(most + 1);
  if (glm::all(glm::lessThanEqual(grown, glm::ivec3(most)))) return grown;
  std::uint64_t edge = 1;
  while (8 * edge * edge * edge <= slots || edge * edge * static_cast<std::uint64_t>(most) < slots) edge *= 2;
  return {static_cast<int>(edge), static_cast<int>(edge),
          static_cast<int>((slots + edge * edge - 1) / (edge * edge))};
}

BrickAtlas::BrickAtlas(gpu::Context& context, std::span<const VkFormat> channels,
                       std::span<const VkFormat> derived, bool tight, std::uint32_t room)
    : context_(context),
      channel_formats_(channels.begin(), channels.end()),
      derived_formats_(derived.begin(), derived.end()),
      tight_(tight),
      channels_(channels.size()),
      derived_(derived.size()) {
  gpu::grow(context, pages_, 1);
  gpu::grow(context, slot_bricks_, 1);
  make_images(room > 1 ? volume::grown_atlas({}, room) : glm::ivec3(1));
}

void BrickAtlas::make_images(glm::ivec3 bricks) {
  // Large ones do not fit twice.
  if (tight_) {
    atlas_bricks_ = glm::ivec3(0);
    for (gpu::Image& image : channels_) image = gpu::Image();
  }
  // All or none are replaced.
  std::vector<gpu::Image> channels, derived;
  for (const VkFormat format : channel_formats_) channels.push_back(make_image(context_, bricks, format, 0));
  for (const VkFormat format : derived_formats_)
    derived.push_back(make_image(context_, bricks, format, VK_IMAGE_USAGE_STORAGE_BIT));
  // The images keep their places, which passes refer to.
  std::ranges::move(channels, channels_.begin());
  std::ranges::move(derived, derived_.begin());
  atlas_bricks_ = bricks;
}

bool BrickAtlas::is_reserved(VolumeList volumes) const {
  return std::ranges::equal(
      volumes, entries_.get(context_), [](const volume::SparseVolume* volume, const Entry& entry) {
        return volume->id() == entry.id && volume->structure_generation() == entry.reserved_generation;
      });
}

/// Lays the volumes out one behind the other. A volume has room to grow, so that those behind it rarely move.
std::vector<BrickAtlas::Entry> BrickAtlas::place(VolumeList volumes) const {
  const std::vector<Entry>& before = entries_.get(context_);
  std::vector<Entry> placed;
  std::uint32_t first_page = 0, first_slot = 0;
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    const volume::SparseVolume& volume = *volumes[i];
    BRUME_ASSERT(volume.channel_count() == channels_.size(), std::to_string(volume.channel_count()));
    Entry entry;
    if (i < before.size() && before[i].id == volume.id()) entry = before[i];
    entry.id = volume.id();
    entry.reserved_generation = volume.structure_generation();

    // Room for pages doubles, or grows in steps where memory is tight.
    const std::size_t pages = volume.pages().root().size() + volume.pages().nodes().size();
    constexpr std::size_t kPageStep = 1u << 14;
    const std::size_t page_room =
        tight_ && pages > kPageStep ? (pages + kPageStep - 1) / kPageStep * kPageStep : std::bit_ceil(pages);
    entry.pages = std::max(entry.pages, static_cast<std::uint32_t>(page_room));

    // What moves is uploaded whole.
    entry.everything |= entry.layout.first_page != first_page || entry.layout.first_slot != first_slot;
    entry.layout = volume.layout().bricks;
    entry.layout.first_page = first_page;
    entry.layout.first_slot = first_slot;
    entry.slots = room_of(volume, tight_);
    first_page += entry.pages;
    first_slot += entry.slots;
    placed.push_back(entry);
  }
  return placed;
}

void BrickAtlas::reserve(VolumeList volumes) {
  if (is_reserved(volumes)) return;
  std::vector<Entry> placed = place(volumes);
  std::vector<Entry>& entries = entries_.change(context_);
  entries.clear();
  std::uint64_t pages = 0, slots = 0;
  for (const Entry& entry : placed) {
    pages += entry.pages;
    slots += entry.slots;
  }
  if (slots > 0) {
    const glm::ivec3 bricks = atlas_for(slots);
    bool replaced = gpu::grow(context_, pages_, pages * sizeof(std::uint32_t));
    replaced |= gpu::grow(context_, slot_bricks_, slots * sizeof(glm::ivec3));
    if (bricks != atlas_bricks_) {
      make_images(bricks);
      replaced = true;
    }
    for (Entry& entry : placed) {
      volume::set_atlas(entry.layout, atlas_bricks_);
      entry.everything |= replaced;
    }
  }
  entries = std::move(placed);
}

void BrickAtlas::clear(glm::ivec3 bricks) {
  entries_.change(context_).clear();
  if (bricks != atlas_bricks_) make_images(bricks);
}

glm::ivec3 BrickAtlas::atlas_for(std::uint64_t slots) const {
  if (!tight_) return volume::grown_atlas({}, slots);
  return tight_atlas(slots, static_cast<int>(context_.limits().maxImageDimension3D) / shared::kBrickTexels);
}

BrickAtlas::Upload BrickAtlas::record(gpu::Recorder& recorder, VolumeList volumes,
                                      std::span<const StreamedBricks> streams) {
  Upload most = Upload::nothing;
  std::vector<Entry>& entries = recorder.change(entries_);
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    if (!streams.empty() && streams[i].streamed) {
      record_stream(recorder, *volumes[i], streams[i], entries[i]);
      if (!streams[i].slots.empty()) most = std::max(most, Upload::changes);
    } else {
      most = std::max(most, record_volume(recorder, *volumes[i], entries[i]));
    }
  }
  return most;
}

void BrickAtlas::record_stream(gpu::Recorder& recorder, const volume::SparseVolume& volume,
                               const StreamedBricks& stream, Entry& entry) {
  if (stream.pages) {
    record_pages(recorder, volume.pages(), true, entry);
    entry.everything = false;
    entry.uploaded_revision = volume.revision();
  }
  BRUME_ASSERT(stream.slots.empty() || !entry.everything, "bricks before the page table that finds them");
  record_bricks(recorder, volume, stream.slots, entry);
  for (std::uint32_t i = 0; i < volume.channel_count(); ++i)
    record_texels(recorder, volume, volume::ChannelId{i}, stream.slots, entry);
}

BrickAtlas::Upload BrickAtlas::record_volume(gpu::Recorder& recorder, const volume::SparseVolume& volume,
                                             Entry& entry) {
  if (volume.slot_count() == 0 || (!entry.everything && volume.revision() == entry.uploaded_revision))
    return Upload::nothing;
  // What is dirty is only that since the revision before: a reader that missed one takes everything.
  const bool all = entry.everything || volume.revision() != entry.uploaded_revision + 1;
  entry.uploaded_revision = volume.revision();
  entry.everything = false;

  const FrameVector<std::uint32_t> every_slot = all_slots(all ? volume.slot_count() : 0, &recorder.memory());
  const auto changed = [&](std::span<const std::uint32_t> dirty) {
    return all ? std::span<const std::uint32_t>(every_slot) : dirty;
  };
  record_pages(recorder, volume.pages(), all, entry);
  record_bricks(recorder, volume, changed(volume.dirty_bricks()), entry);
  bool any = all || !volume.dirty_bricks().empty();
  for (std::uint32_t i = 0; i < volume.channel_count(); ++i) {
    const volume::ChannelId channel{i};
    record_texels(recorder, volume, channel, changed(volume.dirty(channel)), entry);
    any |= !volume.dirty(channel).empty();
  }
  return all ? Upload::everything : any ? Upload::changes : Upload::nothing;
}

void BrickAtlas::record_pages(gpu::Recorder& recorder, const volume::PageTable& pages, bool all,
                              Entry& entry) {
  const std::size_t first = entry.layout.first_page * sizeof(std::uint32_t);
  const std::size_t nodes_first = first + pages.root().size_bytes();
  if (all || pages.root_changed()) recorder.upload(pages_, first, std::as_bytes(pages.root()));
  // The nodes follow the root: another window moves all of them.
  if (all || pages.root().size() != entry.root_entries) {
    recorder.upload(pages_, nodes_first, std::as_bytes(pages.nodes()));
  } else {
    for (const std::uint32_t node : pages.changed_nodes()) {
      const auto entries =
          pages.nodes().subspan(std::size_t{node} * shared::kPageEntries, shared::kPageEntries);
      recorder.upload(pages_, nodes_first + node * entries.size_bytes(), std::as_bytes(entries));
    }
  }
  entry.root_entries = pages.root().size();
}

void BrickAtlas::record_bricks(gpu::Recorder& recorder, const volume::SparseVolume& volume,
                               std::span<const std::uint32_t> slots, const Entry& entry) {
  FrameVector<glm::ivec3> bricks(&recorder.memory());
  for_each_run(slots, [&](const SlotRun& run) {
    bricks.clear();
    for (std::uint32_t slot = run.first; slot < run.first + run.count; ++slot)
      bricks.push_back(volume.brick_of(slot));
    const std::size_t first = std::size_t{entry.layout.first_slot} + run.first;
    recorder.upload(slot_bricks_, first * sizeof(glm::ivec3), std::as_bytes(std::span(bricks)));
  });
}

void BrickAtlas::record_texels(gpu::Recorder& recorder, const volume::SparseVolume& volume,
                               volume::ChannelId channel, std::span<const std::uint32_t> slots,
                               const Entry& entry) {
  FrameVector<gpu::Recorder::Region> regions(&recorder.memory());
  regions.reserve(slots.size());
  for (const std::uint32_t slot : slots) {
    regions.push_back({volume.channel(channel, slot),
                       glm::ivec3(shared::atlas_first_texel(entry.layout, slot)),
                       glm::uvec3(static_cast<std::uint32_t>(shared::kBrickTexels))});
  }
  recorder.upload(this->channel(channel), regions);
}

FrameVector<std::uint32_t> all_slots(std::uint32_t slot_count, Allocator memory) {
  FrameVector<std::uint32_t> slots(slot_count, memory);
  std::iota(slots.begin(), slots.end(), 0u);
  return slots;
}

}  // namespace brume::passes
