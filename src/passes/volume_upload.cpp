#include "passes/volume_upload.hpp"

#include <array>

namespace brume::passes {
namespace {

constexpr std::array kVolumeChannels{VK_FORMAT_R16_SFLOAT};

std::vector<const volume::SparseVolume*> list_of(std::span<const planning::VolumeInput> volumes) {
  std::vector<const volume::SparseVolume*> list;
  for (const planning::VolumeInput& volume : volumes) list.push_back(volume.volume);
  return list;
}

}  // namespace

VolumeUpload::VolumeUpload(gpu::Context& context) : atlas_(context, kVolumeChannels) {
  gpu::grow(context, instances_, shared::kMaxVolumes * sizeof(shared::VolumeInstance));
}

void VolumeUpload::reserve(std::span<const planning::VolumeInput> volumes) {
  atlas_.reserve(list_of(volumes));
}

void VolumeUpload::record(gpu::Recorder& recorder, std::span<const planning::VolumeInput> volumes,
                          std::span<const planning::VisibleVolume> visible) {
  atlas_.record(recorder, list_of(volumes));
  std::vector<shared::VolumeInstance> instances;
  for (const planning::VisibleVolume& volume : visible) {
    instances.push_back(volume.instance);
    instances.back().bricks = atlas_.layout(volume.index);
  }
  recorder.upload(instances_, 0, std::as_bytes(std::span(instances)));
}

}  // namespace brume::passes
