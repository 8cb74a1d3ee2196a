// Solid voxels of the level on the device, for rays and for light.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/box.hpp"
#include "gpu/recorder.hpp"
#include "planning/frame_input.hpp"
#include "shared/solid_volume.h"
#include "sim/level_edit.hpp"
#include "voxel/bit_grid.hpp"

namespace brume::passes {

using planning::LevelView;

constexpr int kMaxSolidAxis = 256;
constexpr std::uint32_t kMaxSolidTexels = 1u << 20;

class SolidVolume {
 public:
  /// A volume without solid voxels.
  explicit SolidVolume(gpu::Context& context);

  /// Allocates for the level. Outside of a recording, once the device has finished previous ones. Levels with
  /// equal layouts count as snapshots of one level. Throws resource_limit.
  void reserve(const LevelView& level);
  /// The next record takes everything: the level may be another one of the same layout, or none.
  void invalidate();
  /// Uploads changes since the last record; true when there were any. `reserve` was given the same level.
  bool record(gpu::Recorder& recorder, const LevelView& level);

  const shared::SolidLayout& layout() const { return frame_; }
  /// R8, see shared/solid_volume.h; clamped at its edges.
  const gpu::Image& texels() const { return texels_; }
  const gpu::Buffer& words() const { return words_; }
  std::uint32_t word_count() const { return static_cast<std::uint32_t>(bits_.size()); }

 private:
  void make(const voxel::GridLayout& grid);
  /// Recomputes the bits of the texels in a box from the level.
  void fill_bits(const voxel::BitGrid& grid, const Box<int>& texels);
  void upload(gpu::Recorder& recorder, const Box<int>& texels) const;

  gpu::Context& context_;
  voxel::GridLayout grid_layout_;
  int voxels_per_texel_ = 1;
  shared::SolidLayout frame_{};
  std::vector<std::uint32_t> bits_;  // as in words_
  /// The level that is on the device.
  struct Held {
    std::shared_ptr<const sim::EditBlocks> edits;
    bool everything = true;  // all is to be uploaded: the resources are new and empty
    bool has_grid = false;
  };
  gpu::Recorded<Held> held_;
  gpu::Image texels_;
  gpu::Buffer words_;
};

}  // namespace brume::passes
