// The smoke on the device: bricks, cells and corner sets, uploaded where they changed.
#pragma once

#include "gpu/recorder.hpp"
#include "planning/smoke_visibility.hpp"
#include "smoke/smoke_volume.hpp"

namespace brume::passes {

/// What every pass that reads density binds.
struct SmokeResources {
  gpu::Buffer pages, cells, boundary, corners;
  gpu::Buffer slot_bricks;  ///< Per slot its brick, in bricks of the grid.
  gpu::Image density;       ///< RG8 atlas.
  gpu::Image inscatter;     ///< Half-float RGBA atlas of the same layout.
  gpu::Image density_displacement;        ///< Likewise; made by passes/drift.hpp, as the next.
  gpu::Image filtered_density;         ///< Half-float RG: what the noise leaves of it in the mean of a texel.
  gpu::Buffer filled;       ///< Per slot the cells in which smoke may be.
  gpu::Buffer slots;        ///< SmokeVisibility::slots of the frame.
  std::uint32_t slot_count = 0;
  std::uint32_t needed = 0;  ///< How many `slots` has.
};

/// The cells of a slot in which smoke may be, as shared::pack_cells packs them.
std::uint32_t filled_cells(const smoke::SmokeVolume& volume, std::uint32_t slot);

class SmokeUpload {
 public:
  /// The resources are those of a world without smoke until the first record.
  explicit SmokeUpload(gpu::Context& context);

  /// Makes room for what the volume holds. Not between the begin and the end of a recording, and only when
  /// the device is done with what it recorded before. Throws resource_limit.
  void reserve(const smoke::SmokeVolume& volume);
  /// Uploads what changed since the last record; true when anything did. The volume must be as `reserve` saw
  /// it.
  bool record(gpu::Recorder& recorder, const smoke::SmokeVolume& volume);

  /// Uploads what the frame needs of the volume that `reserve` saw.
  void record_visibility(gpu::Recorder& recorder, const planning::SmokeVisibility& visibility);

  const SmokeResources& resources() const { return resources_; }

 private:
  /// Those that passes write.
  void make_written_atlases(glm::ivec3 bricks);
  void record_pages(gpu::Recorder& recorder, const volume::PageTable& pages, bool all);
  void record_cells(gpu::Recorder& recorder, const smoke::SmokeVolume& volume,
                    std::span<const std::uint32_t> slots);
  void record_filled(gpu::Recorder& recorder, const smoke::SmokeVolume& volume,
                     std::span<const std::uint32_t> slots);
  void record_texels(gpu::Recorder& recorder, const smoke::SmokeVolume& volume,
                     std::span<const std::uint32_t> slots);

  gpu::Context& context_;
  SmokeResources resources_;
  std::uint64_t reserved_generation_ = 0, uploaded_revision_ = 0;
  std::size_t root_entries_ = 0;
  bool everything_ = true;  // a resource is new and empty
};

}  // namespace brume::passes
