#include "passes/volume_upload.hpp"

#include <algorithm>
#include <array>

namespace brume::passes {
namespace {

constexpr std::array kVolumeChannels{VK_FORMAT_R16_SFLOAT}, kColorChannels{VK_FORMAT_R16G16B16A16_SFLOAT},
    kPairChannels{VK_FORMAT_R16G16_SFLOAT};

/// The grids of all volumes, each once: the densities, those that glow, and the previews of both.
struct GridList {
  std::vector<const volume::SparseVolume*> grids;
  std::vector<StreamedBricks> streams;  ///< By grid, if residency is known.

  void add(const volume::SparseVolume* grid, const planning::BrickUpload* upload) {
    if (!grid) return;
    const auto at = static_cast<std::size_t>(std::ranges::find(grids, grid) - grids.begin());
    if (at == grids.size()) {
      grids.push_back(grid);
      streams.emplace_back();
    }
    if (upload && upload->streamed) streams[at] = {upload->streamed, upload->pages, upload->slots};
  }
};
GridList list_of(std::span<const planning::VolumeInput> volumes,
                 std::span<const planning::VolumeResidency> residency = {}) {
  GridList list;
  for (std::size_t i = 0; i < volumes.size(); ++i)
    list.add(volumes[i].volume, residency.empty() ? nullptr : &residency[i].volume);
  for (std::size_t i = 0; i < volumes.size(); ++i)
    list.add(volumes[i].heat.volume, residency.empty() ? nullptr : &residency[i].heat);
  for (const planning::VolumeInput& volume : volumes) {
    list.add(volume.preview, nullptr);
    list.add(volume.heat.preview, nullptr);
  }
  return list;
}

// Every device of Vulkan has uniform buffers of so many bytes.
static_assert(shared::kMaxVolumes * sizeof(shared::VolumeInstance) <= 16384);

gpu::Buffer make_instances(gpu::Context& context) {
  return {context, shared::kMaxVolumes * sizeof(shared::VolumeInstance),
          VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT};
}

/// Whether the colours of a volume are up to two masks.
bool has_pair(const planning::VolumeInput& volume) {
  return volume.colors && !volume.tints.empty() && volume.tints.size() <= 2;
}

/// The grids of colours, or of pairs of masks, each once.
std::vector<const volume::SparseVolume*> color_list_of(std::span<const planning::VolumeInput> volumes,
                                                       bool pairs) {
  std::vector<const volume::SparseVolume*> list;
  for (const planning::VolumeInput& volume : volumes)
    if (volume.colors && has_pair(volume) == pairs && std::ranges::find(list, volume.colors) == list.end())
      list.push_back(volume.colors);
  return list;
}

gpu::Image make_colors(gpu::Context& context) {
  return gpu::Image(context, gpu::sampled_image({shared::kVolumeColors, shared::kMaxVolumes},
                                                VK_FORMAT_R16G16B16A16_SFLOAT));
}

}  // namespace

VolumeUpload::VolumeUpload(gpu::Context& context)
    : context_(context),
      linear_(context, {}),
      atlas_(context, kVolumeChannels, {}, true),
      color_atlas_(context, kColorChannels, {}, true),
      pair_atlas_(context, kPairChannels, {}, true),
      instances_(make_instances(context)),
      lit_instances_(make_instances(context)),
      colors_(make_colors(context)) {
  gpu::grow(context_, transfers_, sizeof(glm::vec4));
  gpu::grow(context_, effects_, shared::kMaxVolumes * sizeof(shared::VolumeEffect));
}

std::vector<std::uint64_t> VolumeUpload::reserve(std::span<const planning::VolumeInput> volumes) {
  const GridList list = list_of(volumes);
  atlas_.reserve(list.grids);
  color_atlas_.reserve(color_list_of(volumes, false));
  pair_atlas_.reserve(color_list_of(volumes, true));
  std::vector<std::uint64_t> missing;
  for (std::size_t i = 0; i < list.grids.size(); ++i)
    if (atlas_.is_missing(i)) missing.push_back(list.grids[i]->id());
  const auto has_transfer = [](const planning::VolumeInput& volume) { return !volume.transfer.empty(); };
  if (std::ranges::none_of(volumes, has_transfer)) return missing;
  const std::size_t entries = volumes.size() * shared::kTransferEntries;
  if (gpu::grow(context_, transfers_, entries * sizeof(glm::vec4))) uploaded_.change(context_).clear();
  return missing;
}

void VolumeUpload::record(gpu::Recorder& recorder, std::span<const planning::VolumeInput> volumes,
                          std::span<const planning::VolumeResidency> residency,
                          std::span<const planning::PlacedVolume> visible,
                          std::span<const planning::PlacedVolume> lit) {
  const GridList list = list_of(volumes, residency);
  atlas_.record(recorder, list.grids, list.streams);
  color_atlas_.record(recorder, color_list_of(volumes, false));
  pair_atlas_.record(recorder, color_list_of(volumes, true));
  record_instances(recorder, volumes, visible, instances_);
  record_effects(recorder, visible);
  record_instances(recorder, volumes, lit, lit_instances_);
  std::vector<planning::VolumeTables>& uploaded = recorder.change(uploaded_);
  uploaded.resize(visible.size());
  record_glows(recorder, visible);
  record_transfers(recorder, visible);
  for (std::size_t i = 0; i < visible.size(); ++i) uploaded[i] = visible[i].tables;
}

void VolumeUpload::record_part(gpu::Recorder& recorder, std::span<const planning::VolumeInput> volumes,
                               std::span<const planning::VolumeResidency> part) {
  GridList list = list_of(volumes, part);
  for (StreamedBricks& stream : list.streams) stream.streamed = true;
  atlas_.record(recorder, list.grids, list.streams);
}

void VolumeUpload::record_instances(gpu::Recorder& recorder, std::span<const planning::VolumeInput> volumes,
                                    std::span<const planning::PlacedVolume> visible,
                                    const gpu::Buffer& to) const {
  const std::vector<const volume::SparseVolume*> grids = list_of(volumes).grids;
  const std::vector<const volume::SparseVolume*> color_grids = color_list_of(volumes, false),
                                                 pairs = color_list_of(volumes, true);
  const auto position = [](const std::vector<const volume::SparseVolume*>& list,
                           const volume::SparseVolume* grid) {
    return static_cast<std::size_t>(std::ranges::find(list, grid) - list.begin());
  };
  const auto layout_of = [&](const volume::SparseVolume* grid) {
    return atlas_.layout(position(grids, grid));
  };

  // Instances of the plan, with where the atlases hold their bricks.
  std::vector<shared::VolumeInstance> instances;
  for (const planning::PlacedVolume& volume : visible) {
    shared::VolumeInstance instance = volume.instance;
    instance.bricks = layout_of(volume.grids.volume);
    if (instance.heat_per_value > 0) instance.heat_bricks = layout_of(volume.grids.heat);
    if (instance.color_kind == shared::kColorsPair)
      instance.color_bricks = pair_atlas_.layout(position(pairs, volume.grids.colors));
    else if (instance.color_kind != shared::kColorsNone)
      instance.color_bricks = color_atlas_.layout(position(color_grids, volume.grids.colors));
    instances.push_back(instance);
  }
  recorder.upload(to, 0, std::as_bytes(std::span(instances)));
}

/// Only where there are any: a shader without effects does not read them.
void VolumeUpload::record_effects(gpu::Recorder& recorder,
                                  std::span<const planning::PlacedVolume> visible) const {
  std::vector<shared::VolumeEffect> effects;
  bool any = false;
  for (const planning::PlacedVolume& volume : visible) {
    effects.push_back(volume.effect);
    const shared::VolumeInstance& instance = volume.instance;
    any = any || instance.color_kind >= shared::kColorsMasks || instance.detail.strength > 0 ||
          volume.effect.amplitude != glm::vec3(0);
  }
  if (any) recorder.upload(effects_, 0, std::as_bytes(std::span(effects)));
}

void VolumeUpload::record_glows(gpu::Recorder& recorder, std::span<const planning::PlacedVolume> visible) {
  const auto is_uploaded = [](const planning::PlacedVolume& volume, const planning::VolumeTables& uploaded) {
    return !volume.tables.glow || volume.tables.glow == uploaded.glow;
  };
  if (std::ranges::equal(visible, uploaded_.get(context_), is_uploaded)) return;
  // A filter reads the row after the last one, too, with a weight of 0: it must hold numbers.
  const std::uint32_t rows = std::min(static_cast<std::uint32_t>(visible.size()) + 1, shared::kMaxVolumes);
  FrameVector<std::uint64_t> colors(std::size_t{rows} * shared::kVolumeColors, 0, &recorder.memory());
  for (std::size_t i = 0; i < visible.size(); ++i)
    if (const auto& glow = visible[i].tables.glow)
      std::ranges::copy(*glow, colors.begin() + static_cast<std::ptrdiff_t>(i * shared::kVolumeColors));
  const gpu::Recorder::Region used{
      std::as_bytes(std::span(colors)), glm::ivec3(0), {shared::kVolumeColors, rows, 1}};
  recorder.upload(colors_, {&used, 1});
}

void VolumeUpload::record_transfers(gpu::Recorder& recorder,
                                    std::span<const planning::PlacedVolume> visible) {
  for (std::size_t i = 0; i < visible.size(); ++i) {
    const auto& table = visible[i].tables.transfer;
    if (!table || table == uploaded_.get(context_)[i].transfer) continue;
    recorder.upload(transfers_, i * table->size() * sizeof(glm::vec4), std::as_bytes(std::span(*table)));
  }
}

}  // namespace brume::passes
