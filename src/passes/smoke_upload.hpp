// The smoke on the device: a BrickAtlas, cells and corner sets, uploaded where they changed.
#pragma once

#include <array>

#include "gpu/recorder.hpp"
#include "passes/brick_atlas.hpp"
#include "planning/smoke_visibility.hpp"
#include "shared/light_side.h"
#include "shared/smoke_volume.h"
#include "smoke/smoke_bricks.hpp"

namespace brume::passes {

/// What every pass that reads density binds. The references are to resources of the SmokeUpload's BrickAtlas.
struct SmokeResources {
  const gpu::Buffer& pages;
  const gpu::Buffer& slot_bricks;          ///< Per slot its brick, in bricks of the grid.
  const gpu::Image& density;               ///< RG8 atlas: smoke::kDensityChannel.
  const gpu::Image& inscatter;             ///< Half-float RGBA atlas of the same layout.
  const gpu::Image& density_displacement;  ///< Likewise; written by NoiseAdvectionPass, as the next.
  const gpu::Image& filtered_density;  ///< Half-float RG: what noise leaves of the mean density of a texel.
  const gpu::Image& light_side;        ///< Half-float RGBA; written with the in-scatter.
  const gpu::Sampler& linear;
  gpu::Buffer cells{}, boundary{}, corners{};
  gpu::Buffer filled{};  ///< Per slot the cells that smoke may be in.
  gpu::Buffer slots{};   ///< SmokeVisibility::slots of the frame.
  std::uint32_t slot_count = 0;
  std::uint32_t required_count = 0;  ///< How many `slots` has.

  /// All that shaders read of the smoke.
  auto bindings() const {
    return std::to_array<gpu::BoundResource>({
        {shared::kBindPages, gpu::read(pages)},
        {shared::kBindSlotBricks, gpu::read(slot_bricks)},
        {shared::kBindCells, gpu::read(cells)},
        {shared::kBindBoundary, gpu::read(boundary)},
        {shared::kBindCorners, gpu::read(corners)},
        {shared::kBindFilled, gpu::read(filled)},
        {shared::kBindDensity, gpu::sampled(density, linear)},
        {shared::kBindDensityDisplacement, gpu::sampled(density_displacement, linear)},
        {shared::kBindFilteredDensity, gpu::sampled(filtered_density, linear)},
        {shared::kBindInscatter, gpu::sampled(inscatter, linear)},
        {shared::kBindLightSide, gpu::sampled(light_side, linear)},
    });
  }
};

/// The cells of a slot that smoke may be in, as shared::pack_cells packs them.
std::uint32_t filled_cells(const smoke::SmokeBricks& volume, std::uint32_t slot);

class SmokeUpload {
 public:
  /// A volume without smoke until the first record, in an atlas with room for `room` bricks.
  explicit SmokeUpload(gpu::Context& context, std::uint32_t room = 1);

  /// Allocates for the volume. Outside of a recording, once the device has finished previous ones. Throws
  /// resource_limit.
  void reserve(const smoke::SmokeBricks& volume);
  /// Gives back the memory of what `reserve` makes room for, but for an atlas of this size; all is uploaded
  /// again. When `reserve` may be called, and before it is.
  void trim(glm::ivec3 atlas_bricks);
  /// Uploads changes since the last record; true when there were any. `reserve` was given the same volume.
  bool record(gpu::Recorder& recorder, const smoke::SmokeBricks& volume);

  /// Uploads which slots of the volume that `reserve` saw are visible in the frame.
  void record_visibility(gpu::Recorder& recorder, const planning::SmokeVisibility& visibility);

  const SmokeResources& resources() const { return resources_; }
  /// Bricks per axis of the atlas.
  glm::ivec3 atlas_bricks() const { return atlas_.atlas_bricks(); }

 private:
  void record_cells(gpu::Recorder& recorder, const smoke::SmokeBricks& volume,
                    std::span<const std::uint32_t> slots);
  void record_filled(gpu::Recorder& recorder, const smoke::SmokeBricks& volume,
                     std::span<const std::uint32_t> slots);

  gpu::Context& context_;
  BrickAtlas atlas_;
  gpu::Sampler linear_;
  SmokeResources resources_;
  std::uint64_t reserved_volume_ = 0, reserved_generation_ = 0;  // what `reserve` saw last
  /// What of a volume is on the device.
  struct Uploaded {
    std::uint64_t volume = 0, revision = 0;
    bool everything = true;  // all is to be uploaded: a buffer is new and empty
  };
  gpu::Recorded<Uploaded> uploaded_;
};

}  // namespace brume::passes
