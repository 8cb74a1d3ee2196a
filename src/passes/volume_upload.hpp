// The volumes besides the smoke on the device: their grids in one BrickAtlas, the instances in view, and the
// colours of those that glow.
#pragma once

#include "passes/brick_atlas.hpp"
#include "planning/media_plan.hpp"

namespace brume::passes {

/// What the march binds. The references are to resources of the VolumeUpload.
struct VolumeResources {
  const gpu::Buffer& pages;
  const gpu::Image& values;      ///< Half floats.
  const gpu::Buffer& instances;  ///< A shared::VolumeInstance per volume in view.
  const gpu::Image& colors;  ///< Half floats: shared::kVolumeColors colours a row, a row per volume in view.
  const gpu::Buffer& transfers;   ///< shared::kTransferEntries per volume in view, where one has any.
  const gpu::Image& color_grids;  ///< Half floats: the atlas of VolumeColors.
};

class VolumeUpload {
 public:
  /// No volumes until the first record.
  explicit VolumeUpload(gpu::Context& context);

  /// Makes room for all volumes of a frame, visible or not. Outside of a recording, once the device has
  /// finished previous ones. Throws resource_limit.
  void reserve(std::span<const planning::VolumeInput> volumes);
  /// Uploads what changed of the volumes that `reserve` saw, and the instances in view.
  void record(gpu::Recorder& recorder, std::span<const planning::VolumeInput> volumes,
              std::span<const planning::VisibleVolume> visible);

  VolumeResources resources() const {
    return {atlas_.pages(), atlas_.channel(kValues),      instances_, colors_,
            transfers_,     color_atlas_.channel(kValues)};
  }

 private:
  static constexpr volume::ChannelId kValues{0};

  void record_glows(gpu::Recorder& recorder, std::span<const planning::VolumeInput> volumes,
                    std::span<const planning::VisibleVolume> visible);
  void record_transfers(gpu::Recorder& recorder, std::span<const planning::VolumeInput> volumes,
                        std::span<const planning::VisibleVolume> visible);

  /// What a table of transfers_ was made from.
  struct TransferSource {
    planning::TransferInput transfer;
    glm::vec3 albedo;
    bool operator==(const TransferSource&) const = default;
  };

  gpu::Context& context_;
  BrickAtlas atlas_, color_atlas_;
  gpu::Buffer instances_, transfers_;
  gpu::Image colors_;
  std::vector<glm::vec3> glows_;  ///< What each row of colors_ was made from.
  std::vector<TransferSource> transfer_sources_;
};

}  // namespace brume::passes
