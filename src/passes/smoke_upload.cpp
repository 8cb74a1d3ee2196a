#include "passes/smoke_upload.hpp"

#include <algorithm>
#include <array>
#include <iterator>

namespace brume::passes {
namespace {

/// Formats of the channel of smoke::SmokeBricks that is uploaded, kDensityChannel.
constexpr std::array kSmokeChannels{VK_FORMAT_R8G8_UNORM};

/// The images that passes write, in the order of their formats.
enum Derived : std::size_t { kInscatter, kDensityDisplacement, kFilteredDensity, kLightSide };
constexpr std::array kDerivedFormats{VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT,
                                     VK_FORMAT_R16G16_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT};

template <typename Value>
void upload_ranges(gpu::Recorder& recorder, const gpu::Buffer& buffer, std::span<const Value> values,
                   std::span<const volume::IndexRange> ranges) {
  for (const volume::IndexRange& range : ranges)
    recorder.upload(buffer, range.first * sizeof(Value),
                    std::as_bytes(values.subspan(range.first, range.count)));
}

}  // namespace

std::uint32_t filled_cells(const smoke::SmokeBricks& volume, std::uint32_t slot) {
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

SmokeUpload::SmokeUpload(gpu::Context& context, std::uint32_t room)
    : context_(context),
      atlas_(context, kSmokeChannels, kDerivedFormats, false, room),
      linear_(context, {}),
      resources_{.pages = atlas_.pages(),
                 .slot_bricks = atlas_.slot_bricks(),
                 .density = atlas_.channel(smoke::kDensityChannel),
                 .inscatter = atlas_.derived(kInscatter),
                 .density_displacement = atlas_.derived(kDensityDisplacement),
                 .filtered_density = atlas_.derived(kFilteredDensity),
                 .light_side = atlas_.derived(kLightSide),
                 .linear = linear_} {
  trim(atlas_.atlas_bricks());
}

void SmokeUpload::trim(glm::ivec3 atlas_bricks) {
  reserved_volume_ = 0;
  atlas_.clear(atlas_bricks);
  gpu::shrink(context_, {&resources_.cells, &resources_.boundary, &resources_.corners, &resources_.filled,
                         &resources_.slots});
}

void SmokeUpload::reserve(const smoke::SmokeBricks& volume) {
  // Not by address: another volume may lie where one was.
  const std::uint64_t id = volume.id();
  if (id != reserved_volume_) uploaded_.change(context_).everything = true;
  if ((id == reserved_volume_ && volume.structure_generation() == reserved_generation_) ||
      volume.slot_count() == 0)
    return;
  reserved_volume_ = 0;
  const volume::SparseVolume* const bricks = &volume.volume();
  atlas_.reserve({&bricks, 1});
  const std::size_t slots = volume.slot_count();
  bool& everything = uploaded_.change(context_).everything;
  everything |= gpu::grow(context_, resources_.cells, slots * shared::kCellsPerBrick * sizeof(std::uint32_t));
  everything |= gpu::grow(context_, resources_.boundary, volume.boundary_cells().size_bytes());
  everything |= gpu::grow(context_, resources_.corners, volume.corner_sets().size_bytes());
  everything |= gpu::grow(context_, resources_.filled, slots * sizeof(std::uint32_t));
  gpu::grow(context_, resources_.slots, slots * sizeof(std::uint32_t));
  reserved_volume_ = id;
  reserved_generation_ = volume.structure_generation();
}

void SmokeUpload::record_visibility(gpu::Recorder& recorder, const planning::SmokeVisibility& visibility) {
  recorder.upload(resources_.slots, 0, std::as_bytes(std::span(visibility.slots)));
  resources_.required_count = static_cast<std::uint32_t>(visibility.slots.size());
}

void SmokeUpload::record_cells(gpu::Recorder& recorder, const smoke::SmokeBricks& volume,
                               std::span<const std::uint32_t> slots) {
  FrameVector<std::uint32_t> cells(&recorder.memory());
  for_each_run(slots, [&](const SlotRun& run) {
    cells.clear();
    for (std::uint32_t slot = run.first; slot < run.first + run.count; ++slot) {
      const auto of_slot = volume.cells(slot);
      cells.insert(cells.end(), of_slot.begin(), of_slot.end());
    }
    recorder.upload(resources_.cells, std::size_t{run.first} * shared::kCellsPerBrick * sizeof(std::uint32_t),
                    std::as_bytes(std::span(cells)));
  });
}

void SmokeUpload::record_filled(gpu::Recorder& recorder, const smoke::SmokeBricks& volume,
                                std::span<const std::uint32_t> slots) {
  FrameVector<std::uint32_t> filled(&recorder.memory());
  for_each_run(slots, [&](const SlotRun& run) {
    filled.clear();
    for (std::uint32_t slot = run.first; slot < run.first + run.count; ++slot)
      filled.push_back(filled_cells(volume, slot));
    recorder.upload(resources_.filled, run.first * sizeof(std::uint32_t), std::as_bytes(std::span(filled)));
  });
}

bool SmokeUpload::record(gpu::Recorder& recorder, const smoke::SmokeBricks& volume) {
  const bool had_smoke = resources_.slot_count > 0;
  resources_.slot_count = volume.slot_count();
  if (volume.slot_count() == 0) return had_smoke;
  const std::uint64_t id = volume.id();
  Uploaded& uploaded = recorder.change(uploaded_);
  const bool everything = uploaded.everything || id != uploaded.volume;
  if (!everything && volume.revision() == uploaded.revision) return false;
  // What is dirty is only that since the revision before: a reader that missed one takes everything.
  const bool all = everything || volume.revision() != uploaded.revision + 1;
  uploaded = {id, volume.revision(), false};

  const volume::SparseVolume* const bricks = &volume.volume();
  const BrickAtlas::Upload bricks_uploaded = atlas_.record(recorder, {&bricks, 1});
  // Everything.
  if (all) {
    const FrameVector<std::uint32_t> slots = all_slots(volume.slot_count(), &recorder.memory());
    record_cells(recorder, volume, slots);
    record_filled(recorder, volume, slots);
    recorder.upload(resources_.boundary, 0, std::as_bytes(volume.boundary_cells()));
    recorder.upload(resources_.corners, 0, std::as_bytes(volume.corner_sets()));
    return true;
  }

  // Only what changed: cells are filled by their texels and by boundary cells.
  record_cells(recorder, volume, volume.dirty_cell_slots());
  FrameVector<std::uint32_t> changed(&recorder.memory());
  std::set_union(volume.dirty_slots().begin(), volume.dirty_slots().end(), volume.dirty_cell_slots().begin(),
                 volume.dirty_cell_slots().end(), std::back_inserter(changed));
  record_filled(recorder, volume, changed);
  upload_ranges(recorder, resources_.boundary, volume.boundary_cells(), volume.dirty_boundary_cells());
  upload_ranges(recorder, resources_.corners, volume.corner_sets(), volume.dirty_corner_sets());
  return volume.corner_sets_dirty() || bricks_uploaded != BrickAtlas::Upload::nothing;
}

}  // namespace brume::passes
