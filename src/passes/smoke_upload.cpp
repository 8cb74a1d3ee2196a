#include "passes/smoke_upload.hpp"

#include <algorithm>
#include <bit>
#include <iterator>
#include <numeric>

#include "core/error.hpp"

namespace brume::passes {
namespace {

gpu::Image make_atlas(gpu::Context& context, glm::ivec3 bricks, VkFormat format, VkImageUsageFlags usage) {
  const glm::uvec3 texels = glm::uvec3(bricks) * static_cast<std::uint32_t>(shared::kBrickTexels);
  const std::uint32_t limit = context.limits().maxImageDimension3D;
  if (texels.x > limit || texels.y > limit || texels.z > limit) {
    throw Error(ErrorCode::resource_limit,
                "the smoke needs more bricks than the device's 3D textures hold; use "
                "larger voxels or less smoke");
  }
  gpu::ImageInfo info;
  info.format = format;
  info.size = texels;
  info.three_dimensional = true;
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | usage;
  return gpu::Image(context, info);
}

/// Slots one after the other.
struct SlotRun {
  std::uint32_t first = 0, count = 0;
};
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

std::vector<std::uint32_t> all_slots(const smoke::SmokeVolume& volume) {
  std::vector<std::uint32_t> slots(volume.slot_count());
  std::iota(slots.begin(), slots.end(), 0u);
  return slots;
}

template <typename Value>
void upload_ranges(gpu::Recorder& recorder, const gpu::Buffer& buffer, std::span<const Value> values,
                   std::span<const volume::IndexRange> ranges) {
  for (const volume::IndexRange& range : ranges)
    recorder.upload(buffer, range.first * sizeof(Value),
                    std::as_bytes(values.subspan(range.first, range.count)));
}

}  // namespace

std::uint32_t filled_cells(const smoke::SmokeVolume& volume, std::uint32_t slot) {
  glm::uvec3 low(shared::kBrickCells), end(0);
  const auto add = [&](glm::uvec3 first, glm::uvec3 last) {
    low = glm::min(low, first);
    end = glm::max(end, last + 1u);
  };
  const auto at = [](std::uint32_t i, std::uint32_t edge) {
    return glm::uvec3(i % edge, i / edge % edge, i / (edge * edge));
  };
  // A texel is a corner of the cells before it and after it.
  const auto texels = volume.texels(slot);
  for (std::uint32_t i = 0; i < texels.size(); ++i) {
    if (texels[i].density == 0) continue;
    const glm::uvec3 texel = at(i, shared::kBrickTexels);
    add(glm::max(texel, 1u) - 1u, glm::min(texel, shared::kBrickCells - 1u));
  }
  const auto cells = volume.cells(slot);
  for (std::uint32_t i = 0; i < cells.size(); ++i)
    if (cells[i] != 0) add(at(i, shared::kBrickCells), at(i, shared::kBrickCells));
  return end.x == 0 ? 0 : shared::pack_cells(low, end);
}

SmokeUpload::SmokeUpload(gpu::Context& context) : context_(context) {
  for (gpu::Buffer* buffer : {&resources_.pages, &resources_.cells, &resources_.boundary, &resources_.corners,
                              &resources_.slot_bricks, &resources_.filled, &resources_.slots}) {
    gpu::grow(context, *buffer, 1);
  }
  resources_.density =
      make_atlas(context, glm::ivec3(1), VK_FORMAT_R8G8_UNORM, VK_IMAGE_USAGE_TRANSFER_DST_BIT);
  make_written_atlases(glm::ivec3(1));
}

void SmokeUpload::reserve(const smoke::SmokeVolume& volume) {
  if (volume.structure_generation() == reserved_generation_ || volume.slot_count() == 0) return;
  reserved_generation_ = volume.structure_generation();
  const std::size_t slots = volume.slot_count();
  everything_ |= gpu::grow(context_, resources_.pages,
                           volume.pages().root().size_bytes() + volume.pages().nodes().size_bytes());
  everything_ |=
      gpu::grow(context_, resources_.cells, slots * shared::kCellsPerBrick * sizeof(std::uint32_t));
  everything_ |= gpu::grow(context_, resources_.boundary, volume.boundary_cells().size_bytes());
  everything_ |= gpu::grow(context_, resources_.corners, volume.corner_sets().size_bytes());
  everything_ |= gpu::grow(context_, resources_.slot_bricks, slots * sizeof(glm::ivec3));
  everything_ |= gpu::grow(context_, resources_.filled, slots * sizeof(std::uint32_t));
  gpu::grow(context_, resources_.slots, slots * sizeof(std::uint32_t));
  const glm::ivec3 bricks = volume.layout().atlas_bricks;
  if (resources_.density.info().size == glm::uvec3(bricks) * static_cast<std::uint32_t>(shared::kBrickTexels))
    return;
  everything_ = true;
  resources_.density = make_atlas(context_, bricks, VK_FORMAT_R8G8_UNORM, VK_IMAGE_USAGE_TRANSFER_DST_BIT);
  make_written_atlases(bricks);
}

void SmokeUpload::make_written_atlases(glm::ivec3 bricks) {
  constexpr VkImageUsageFlags kUses =
      VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  resources_.inscatter = make_atlas(context_, bricks, VK_FORMAT_R16G16B16A16_SFLOAT, kUses);
  resources_.density_displacement = make_atlas(context_, bricks, VK_FORMAT_R16G16B16A16_SFLOAT, kUses);
  resources_.filtered_density = make_atlas(context_, bricks, VK_FORMAT_R16G16_SFLOAT, kUses);
}

void SmokeUpload::record_visibility(gpu::Recorder& recorder, const planning::SmokeVisibility& needs) {
  recorder.upload(resources_.slots, 0, std::as_bytes(std::span(needs.slots)));
  resources_.needed = static_cast<std::uint32_t>(needs.slots.size());
  resources_.seen = needs.seen;
}

void SmokeUpload::record_pages(gpu::Recorder& recorder, const volume::PageTable& pages, bool all) {
  const std::size_t root_bytes = pages.root().size_bytes();
  if (all || pages.root_changed()) recorder.upload(resources_.pages, 0, std::as_bytes(pages.root()));
  // Another window moves all nodes.
  if (all || pages.root().size() != root_entries_) {
    recorder.upload(resources_.pages, root_bytes, std::as_bytes(pages.nodes()));
  } else {
    for (const std::uint32_t node : pages.changed_nodes()) {
      const auto entries =
          pages.nodes().subspan(std::size_t{node} * shared::kPageEntries, shared::kPageEntries);
      recorder.upload(resources_.pages, root_bytes + node * entries.size_bytes(), std::as_bytes(entries));
    }
  }
  root_entries_ = pages.root().size();
}

void SmokeUpload::record_cells(gpu::Recorder& recorder, const smoke::SmokeVolume& volume,
                               std::span<const std::uint32_t> slots) {
  std::vector<std::uint32_t> cells;
  std::vector<glm::ivec3> bricks;
  for (const SlotRun& run : runs_of(slots)) {
    cells.clear();
    bricks.clear();
    for (std::uint32_t slot = run.first; slot < run.first + run.count; ++slot) {
      const auto of_slot = volume.cells(slot);
      cells.insert(cells.end(), of_slot.begin(), of_slot.end());
      bricks.push_back(volume.brick_of(slot));
    }
    recorder.upload(resources_.cells, std::size_t{run.first} * shared::kCellsPerBrick * sizeof(std::uint32_t),
                    std::as_bytes(std::span(cells)));
    recorder.upload(resources_.slot_bricks, run.first * sizeof(glm::ivec3), std::as_bytes(std::span(bricks)));
  }
}

void SmokeUpload::record_filled(gpu::Recorder& recorder, const smoke::SmokeVolume& volume,
                                std::span<const std::uint32_t> slots) {
  std::vector<std::uint32_t> filled;
  for (const SlotRun& run : runs_of(slots)) {
    filled.clear();
    for (std::uint32_t slot = run.first; slot < run.first + run.count; ++slot)
      filled.push_back(filled_cells(volume, slot));
    recorder.upload(resources_.filled, run.first * sizeof(std::uint32_t), std::as_bytes(std::span(filled)));
  }
}

void SmokeUpload::record_texels(gpu::Recorder& recorder, const smoke::SmokeVolume& volume,
                                std::span<const std::uint32_t> slots) {
  std::vector<gpu::Recorder::Region> regions;
  regions.reserve(slots.size());
  for (const std::uint32_t slot : slots) {
    regions.push_back({std::as_bytes(volume.texels(slot)),
                       glm::ivec3(shared::atlas_first_texel(volume.layout().atlas_bricks, slot)),
                       glm::uvec3(static_cast<std::uint32_t>(shared::kBrickTexels))});
  }
  recorder.upload(resources_.density, regions);
}

bool SmokeUpload::record(gpu::Recorder& recorder, const smoke::SmokeVolume& volume) {
  const bool had_smoke = resources_.slot_count > 0;
  resources_.slot_count = volume.slot_count();
  if (volume.slot_count() == 0) return had_smoke;
  if (volume.revision() == uploaded_revision_) return false;
  // What is dirty is only that since the revision before: whoever missed one takes everything.
  const bool all = everything_ || volume.revision() != uploaded_revision_ + 1;
  uploaded_revision_ = volume.revision();
  everything_ = false;
  record_pages(recorder, volume.pages(), all);
  if (all) {
    const std::vector<std::uint32_t> slots = all_slots(volume);
    record_cells(recorder, volume, slots);
    record_filled(recorder, volume, slots);
    recorder.upload(resources_.boundary, 0, std::as_bytes(volume.boundary_cells()));
    recorder.upload(resources_.corners, 0, std::as_bytes(volume.corner_sets()));
    record_texels(recorder, volume, slots);
    return true;
  }
  record_cells(recorder, volume, volume.dirty_cell_slots());
  std::vector<std::uint32_t> changed;
  std::set_union(volume.dirty_slots().begin(), volume.dirty_slots().end(), volume.dirty_cell_slots().begin(),
                 volume.dirty_cell_slots().end(), std::back_inserter(changed));
  record_filled(recorder, volume, changed);
  upload_ranges(recorder, resources_.boundary, volume.boundary_cells(), volume.dirty_boundary_cells());
  upload_ranges(recorder, resources_.corners, volume.corner_sets(), volume.dirty_corner_sets());
  record_texels(recorder, volume, volume.dirty_slots());
  return volume.corner_sets_dirty() || !volume.dirty_slots().empty();
}

}  // namespace brume::passes
