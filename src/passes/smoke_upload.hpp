// The smoke on the device: uploads bricks, cells and corner sets where they changed.
#pragma once

#include "gpu/recorder.hpp"
#include "planning/smoke_visibility.hpp"
#include "smoke/smoke_volume.hpp"

namespace brume::passes {

/// The smoke volume on the device, for every pass that reads it (shared/smoke_volume.h).
struct SmokeResources {
  gpu::Buffer pages, cells, boundary, corners;
  gpu::Buffer slot_bricks;          ///< Per slot its brick, in bricks of the grid.
  gpu::Image density;               ///< RG8 atlas.
  gpu::Image inscatter;             ///< Half-float RGBA atlas of the same layout.
  gpu::Image density_displacement;  ///< Likewise; written by NoiseAdvectionPass, as the next.
  gpu::Image filtered_density;      ///< Half-float RG: mean density of a texel after erosion.
  gpu::Buffer filled;               ///< Per slot the cells that may hold smoke.
  gpu::Buffer slots;                ///< SmokeVisibility::slots of the frame.
  std::uint32_t slot_count = 0;
  std::uint32_t needed = 0, seen = 0;  ///< Entries of `slots`, and how many of them may be visible.
};

/// The cells of a slot that may hold smoke, packed by shared::pack_cells.
std::uint32_t filled_cells(const smoke::SmokeVolume& volume, std::uint32_t slot);

class SmokeUpload {
 public:
  /// A volume without smoke until the first record.
  explicit SmokeUpload(gpu::Context& context);

  /// Allocates for the volume. Outside of a recording, once the device has finished previous ones. Throws
  /// resource_limit.
  void reserve(const smoke::SmokeVolume& volume);
  /// Uploads changes since the last record; true when there were any. The volume is that of `reserve`.
  bool record(gpu::Recorder& recorder, const smoke::SmokeVolume& volume);

  /// Uploads the visibility of the volume that was passed to `reserve`.
  void record_visibility(gpu::Recorder& recorder, const planning::SmokeVisibility& needs);

  const SmokeResources& resources() const { return resources_; }

 private:
  /// Creates the atlases that passes write.
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
