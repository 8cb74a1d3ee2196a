#include "passes/brick_atlas.hpp"

#include <numeric>

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
  gpu::ImageInfo info;
  info.format = format;
  info.size = texels;
  info.three_dimensional = true;
  info.usage =
      usage | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  return gpu::Image(context, info);
}

}  // namespace

BrickAtlas::BrickAtlas(gpu::Context& context, std::span<const VkFormat> channels,
                       std::span<const VkFormat> derived)
    : context_(context),
      channel_formats_(channels.begin(), channels.end()),
      derived_formats_(derived.begin(), derived.end()),
      channels_(channels.size()),
      derived_(derived.size()) {
  gpu::grow(context, pages_, 1);
  gpu::grow(context, slot_bricks_, 1);
  make_images(glm::ivec3(1));
}

void BrickAtlas::make_images(glm::ivec3 bricks) {
  for (std::size_t i = 0; i < channels_.size(); ++i)
    channels_[i] = make_image(context_, bricks, channel_formats_[i], 0);
  for (std::size_t i = 0; i < derived_.size(); ++i)
    derived_[i] = make_image(context_, bricks, derived_formats_[i], VK_IMAGE_USAGE_STORAGE_BIT);
  atlas_bricks_ = bricks;
}

void BrickAtlas::reserve(const volume::SparseVolume& volume) {
  BRUME_ASSERT(volume.channel_count() == channels_.size(), std::to_string(volume.channel_count()));
  everything_ |= &volume != volume_;
  if ((&volume == volume_ && volume.structure_generation() == reserved_generation_) ||
      volume.slot_count() == 0)
    return;
  volume_ = &volume;
  everything_ |=
      gpu::grow(context_, pages_, volume.pages().root().size_bytes() + volume.pages().nodes().size_bytes());
  everything_ |= gpu::grow(context_, slot_bricks_, volume.slot_count() * sizeof(glm::ivec3));
  if (volume.layout().atlas_bricks != atlas_bricks_) {
    everything_ = true;
    make_images(volume.layout().atlas_bricks);
  }
  reserved_generation_ = volume.structure_generation();
}

BrickAtlas::Upload BrickAtlas::record(gpu::Recorder& recorder, const volume::SparseVolume& volume) {
  if (volume.slot_count() == 0 || (!everything_ && volume.revision() == uploaded_revision_))
    return Upload::nothing;
  // What is dirty is only that since the revision before: a reader that missed one takes everything.
  const bool all = everything_ || volume.revision() != uploaded_revision_ + 1;
  uploaded_revision_ = volume.revision();
  everything_ = false;

  const std::vector<std::uint32_t> every_slot =
      all ? all_slots(volume.slot_count()) : std::vector<std::uint32_t>();
  const auto changed = [&](std::span<const std::uint32_t> dirty) {
    return all ? std::span<const std::uint32_t>(every_slot) : dirty;
  };
  record_pages(recorder, volume.pages(), all);
  record_bricks(recorder, volume, changed(volume.dirty_bricks()));
  bool any = all || !volume.dirty_bricks().empty();
  for (std::uint32_t i = 0; i < volume.channel_count(); ++i) {
    const volume::ChannelId channel{i};
    record_texels(recorder, volume, channel, changed(volume.dirty(channel)));
    any |= !volume.dirty(channel).empty();
  }
  return all ? Upload::everything : any ? Upload::changes : Upload::nothing;
}

void BrickAtlas::record_pages(gpu::Recorder& recorder, const volume::PageTable& pages, bool all) {
  const std::size_t root_bytes = pages.root().size_bytes();
  if (all || pages.root_changed()) recorder.upload(pages_, 0, std::as_bytes(pages.root()));
  // The nodes follow the root: another window moves all of them.
  if (all || pages.root().size() != root_entries_) {
    recorder.upload(pages_, root_bytes, std::as_bytes(pages.nodes()));
  } else {
    for (const std::uint32_t node : pages.changed_nodes()) {
      const auto entries =
          pages.nodes().subspan(std::size_t{node} * shared::kPageEntries, shared::kPageEntries);
      recorder.upload(pages_, root_bytes + node * entries.size_bytes(), std::as_bytes(entries));
    }
  }
  root_entries_ = pages.root().size();
}

void BrickAtlas::record_bricks(gpu::Recorder& recorder, const volume::SparseVolume& volume,
                               std::span<const std::uint32_t> slots) {
  std::vector<glm::ivec3> bricks;
  for (const SlotRun& run : runs_of(slots)) {
    bricks.clear();
    for (std::uint32_t slot = run.first; slot < run.first + run.count; ++slot)
      bricks.push_back(volume.brick_of(slot));
    recorder.upload(slot_bricks_, run.first * sizeof(glm::ivec3), std::as_bytes(std::span(bricks)));
  }
}

void BrickAtlas::record_texels(gpu::Recorder& recorder, const volume::SparseVolume& volume,
                               volume::ChannelId channel, std::span<const std::uint32_t> slots) {
  std::vector<gpu::Recorder::Region> regions;
  regions.reserve(slots.size());
  for (const std::uint32_t slot : slots) {
    regions.push_back({volume.channel(channel, slot),
                       glm::ivec3(shared::atlas_first_texel(atlas_bricks_, slot)),
                       glm::uvec3(static_cast<std::uint32_t>(shared::kBrickTexels))});
  }
  recorder.upload(this->channel(channel), regions);
}

std::vector<SlotRun> runs_of(std::span<const std::uint32_t> slots) {
  std::vector<SlotRun> runs;
  for (const std::uint32_t slot : slots) {
    if (!runs.empty() && runs.back().first + runs.back().count == slot)
      ++runs.back().count;
    else
      runs.push_back({slot, 1});
  }
  return runs;
}

std::vector<std::uint32_t> all_slots(std::uint32_t slot_count) {
  std::vector<std::uint32_t> slots(slot_count);
  std::iota(slots.begin(), slots.end(), 0u);
  return slots;
}

}  // namespace brume::passes
