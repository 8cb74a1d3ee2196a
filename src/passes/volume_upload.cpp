#include "passes/volume_upload.hpp"

#include <algorithm>
#include <array>
#include <glm/gtc/packing.hpp>

#include "planning/blackbody.hpp"
#include "planning/transfer_table.hpp"

namespace brume::passes {
namespace {

constexpr std::array kVolumeChannels{VK_FORMAT_R16_SFLOAT}, kColorChannels{VK_FORMAT_R16G16B16A16_SFLOAT};

/// The grids of all volumes: the densities, then those that glow.
std::vector<const volume::SparseVolume*> list_of(std::span<const planning::VolumeInput> volumes) {
  std::vector<const volume::SparseVolume*> list;
  for (const planning::VolumeInput& volume : volumes) list.push_back(volume.volume);
  for (const planning::VolumeInput& volume : volumes)
    if (volume.heat.volume) list.push_back(volume.heat.volume);
  return list;
}

/// The grids of colours.
std::vector<const volume::SparseVolume*> color_list_of(std::span<const planning::VolumeInput> volumes) {
  std::vector<const volume::SparseVolume*> list;
  for (const planning::VolumeInput& volume : volumes)
    if (volume.colors) list.push_back(volume.colors);
  return list;
}

gpu::Image make_colors(gpu::Context& context) {
  gpu::ImageInfo info;
  info.format = VK_FORMAT_R16G16B16A16_SFLOAT;
  info.size = {shared::kVolumeColors, shared::kMaxVolumes, 1};
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  return gpu::Image(context, info);
}

/// All that the colours of a volume follow from.
glm::vec3 glow_of(const planning::HeatInput& heat) {
  return heat.volume ? glm::vec3(heat.kelvin, heat.high, heat.emission) : glm::vec3(0);
}

/// What a grid emits, from a value of 0 to its largest.
std::vector<std::uint64_t> colors_of(const planning::HeatInput& heat) {
  std::vector<std::uint64_t> row;
  for (std::uint32_t i = 0; i < shared::kVolumeColors; ++i) {
    const float value = heat.high * static_cast<float>(i) / static_cast<float>(shared::kVolumeColors - 1);
    const glm::vec3 color = heat.emission * planning::blackbody_color(heat.kelvin * value);
    row.push_back(glm::packHalf4x16(glm::vec4(glm::min(color, 65000.0f), 0)));
  }
  return row;
}

}  // namespace

VolumeUpload::VolumeUpload(gpu::Context& context)
    : context_(context),
      atlas_(context, kVolumeChannels),
      color_atlas_(context, kColorChannels),
      instances_(context, shared::kMaxVolumes * sizeof(shared::VolumeInstance),
                 VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      colors_(make_colors(context)) {
  gpu::grow(context_, transfers_, sizeof(glm::vec4));
}

void VolumeUpload::reserve(std::span<const planning::VolumeInput> volumes) {
  atlas_.reserve(list_of(volumes));
  color_atlas_.reserve(color_list_of(volumes));
  const auto has_transfer = [](const planning::VolumeInput& volume) { return !volume.transfer.empty(); };
  if (std::ranges::none_of(volumes, has_transfer)) return;
  const std::size_t entries = volumes.size() * shared::kTransferEntries;
  if (gpu::grow(context_, transfers_, entries * sizeof(glm::vec4))) transfer_sources_.clear();
}

void VolumeUpload::record(gpu::Recorder& recorder, std::span<const planning::VolumeInput> volumes,
                          std::span<const planning::VisibleVolume> visible) {
  atlas_.record(recorder, list_of(volumes));
  color_atlas_.record(recorder, color_list_of(volumes));
  std::vector<std::size_t> heat_at, colors_at;  // of each volume, in the lists
  std::size_t next_heat = volumes.size(), next_colors = 0;
  for (const planning::VolumeInput& volume : volumes) {
    heat_at.push_back(volume.heat.volume ? next_heat++ : 0);
    colors_at.push_back(volume.colors ? next_colors++ : 0);
  }
  std::vector<shared::VolumeInstance> instances;
  for (const planning::VisibleVolume& volume : visible) {
    shared::VolumeInstance instance = volume.instance;
    instance.bricks = atlas_.layout(volume.index);
    if (instance.heat.per_value > 0) instance.heat.bricks = atlas_.layout(heat_at[volume.index]);
    if (instance.colors.present) instance.colors.bricks = color_atlas_.layout(colors_at[volume.index]);
    instances.push_back(instance);
  }
  recorder.upload(instances_, 0, std::as_bytes(std::span(instances)));
  record_glows(recorder, volumes, visible);
  record_transfers(recorder, volumes, visible);
}

void VolumeUpload::record_glows(gpu::Recorder& recorder, std::span<const planning::VolumeInput> volumes,
                                std::span<const planning::VisibleVolume> visible) {
  std::vector<glm::vec3> glows;
  for (const planning::VisibleVolume& volume : visible) glows.push_back(glow_of(volumes[volume.index].heat));
  if (glows == glows_) return;
  glows_ = std::move(glows);
  std::vector<std::uint64_t> colors;
  for (const planning::VisibleVolume& volume : visible) {
    const std::vector<std::uint64_t> row = colors_of(volumes[volume.index].heat);
    colors.insert(colors.end(), row.begin(), row.end());
  }
  const auto rows = static_cast<std::uint32_t>(visible.size());
  const gpu::Recorder::Region used{
      std::as_bytes(std::span(colors)), glm::ivec3(0), {shared::kVolumeColors, rows, 1}};
  if (rows > 0) recorder.upload(colors_, {&used, 1});
}

void VolumeUpload::record_transfers(gpu::Recorder& recorder, std::span<const planning::VolumeInput> volumes,
                                    std::span<const planning::VisibleVolume> visible) {
  transfer_sources_.resize(visible.size());
  for (std::size_t i = 0; i < visible.size(); ++i) {
    const planning::VolumeInput& volume = volumes[visible[i].index];
    TransferSource source{volume.transfer, volume.look.albedo};
    if (volume.transfer.empty() || source == transfer_sources_[i]) continue;
    const std::vector<glm::vec4> table = planning::transfer_table(volume.transfer, volume.look.albedo);
    recorder.upload(transfers_, i * table.size() * sizeof(glm::vec4), std::as_bytes(std::span(table)));
    transfer_sources_[i] = std::move(source);
  }
}

}  // namespace brume::passes
