// The volumes besides the smoke on the device: their grids in one BrickAtlas, the instances in view, and the
// colours of those that glow.
#pragma once

#include <array>

#include "passes/brick_atlas.hpp"
#include "planning/media_plan.hpp"
#include "planning/volume_streaming.hpp"

namespace brume::passes {

/// What shaders bind. The references are to resources of the VolumeUpload.
struct VolumeResources {
  const gpu::Sampler& linear;
  const gpu::Buffer& pages;
  const gpu::Image& values;      ///< Half floats.
  const gpu::Buffer& instances;  ///< A shared::VolumeInstance per volume in view.
  const gpu::Image& colors;  ///< Half floats: shared::kVolumeColors colours a row, a row per volume in view.
  const gpu::Buffer& transfers;   ///< shared::kTransferEntries per volume in view, where one has any.
  const gpu::Image& color_grids;  ///< Half floats: the atlas of VolumeColors.
  const gpu::Image& mask_pairs;   ///< Two half floats: the same of up to two masks.
  const gpu::Buffer& effects;     ///< A shared::VolumeEffect per volume in view, where one has any.

  /// All that shaders read of the volumes.
  auto bindings() const {
    return std::to_array<gpu::BoundResource>({
        {shared::kBindVolumes, gpu::uniform(instances)},
        {shared::kBindVolumePages, gpu::read(pages)},
        {shared::kBindVolumeValues, gpu::sampled(values, linear)},
        {shared::kBindVolumeColors, gpu::sampled(colors, linear)},
        {shared::kBindTransfers, gpu::read(transfers)},
        {shared::kBindColorGrids, gpu::sampled(color_grids, linear)},
        {shared::kBindMaskPairs, gpu::sampled(mask_pairs, linear)},
        {shared::kBindVolumeEffects, gpu::read(effects)},
    });
  }
};

class VolumeUpload {
 public:
  /// No volumes until the first record.
  explicit VolumeUpload(gpu::Context& context);

  /// Makes room for all volumes of a frame, visible or not, and for their previews. Outside of a recording,
  /// once the device has finished previous ones. Returns the volumes of which nothing is on the device
  /// (SparseVolume::id). Throws resource_limit.
  std::vector<std::uint64_t> reserve(std::span<const planning::VolumeInput> volumes);
  /// Uploads what changed of the volumes that `reserve` saw, or what `residency` says of those that are
  /// streamed, and the instances in view: as rays of the eye meet them, and as light does.
  void record(gpu::Recorder& recorder, std::span<const planning::VolumeInput> volumes,
              std::span<const planning::VolumeResidency> residency,
              std::span<const planning::PlacedVolume> visible, std::span<const planning::PlacedVolume> lit);

  /// Uploads what `part` says of volumes that are streamed, and nothing else.
  void record_part(gpu::Recorder& recorder, std::span<const planning::VolumeInput> volumes,
                   std::span<const planning::VolumeResidency> part);

  VolumeResources resources() const { return resources_with(instances_); }
  /// The same with the instances that light meets.
  VolumeResources lit_resources() const { return resources_with(lit_instances_); }

 private:
  static constexpr volume::ChannelId kValues{0};

  VolumeResources resources_with(const gpu::Buffer& instances) const {
    return {linear_, atlas_.pages(), atlas_.channel(kValues),       instances,
            colors_, transfers_,     color_atlas_.channel(kValues), pair_atlas_.channel(kValues),
            effects_};
  }
  void record_instances(gpu::Recorder& recorder, std::span<const planning::VolumeInput> volumes,
                        std::span<const planning::PlacedVolume> visible, const gpu::Buffer& to) const;
  void record_effects(gpu::Recorder& recorder, std::span<const planning::PlacedVolume> visible) const;
  void record_glows(gpu::Recorder& recorder, std::span<const planning::PlacedVolume> visible);
  void record_transfers(gpu::Recorder& recorder, std::span<const planning::PlacedVolume> visible);

  gpu::Context& context_;
  gpu::Sampler linear_;
  BrickAtlas atlas_, color_atlas_, pair_atlas_;
  gpu::Buffer instances_, lit_instances_, transfers_;
  gpu::Buffer effects_;
  gpu::Image colors_;
  gpu::Recorded<std::vector<planning::VolumeTables>> uploaded_;  ///< In colors_ and transfers_.
};

}  // namespace brume::passes
