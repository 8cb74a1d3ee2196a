// Which holes reach where (shared/hole_grid.h), made anew each frame: holes open, close and are shot.
#pragma once

#include <span>
#include <vector>

#include "passes/hole_masks.hpp"
#include "passes/smoke_upload.hpp"
#include "shared/frame.h"
#include "shared/hole.h"

namespace brume::passes {

/// Most holes that are drawn at a time.
constexpr std::uint32_t kMaxHoles = 16384;

/// What is known of a frame's holes before any is drawn.
struct HolePlan {
  std::vector<shared::Hole> holes;  ///< Those that are open somewhere, the widest first.
  std::uint32_t wide_count = 0;     ///< How many of them every sample asks.
  std::uint32_t pair_capacity = 0;  ///< Never less than the pairs of a brick and a hole that meet,
  std::uint32_t block_capacity = 0;
  std::uint32_t entry_capacity = 0;  ///< or the entries of all cells.
};

/// Plans the holes that are open at `time`, each with a rim that noise moves by at most `rim` metres. Holes
/// that reach very many cells, and holes for which the grid has no room, are wide; with `all_wide` all are:
/// the plain loop.
HolePlan plan_holes(std::span<const shared::Hole> holes, float time, float rim, float voxel_size,
                    std::uint32_t slot_count, bool all_wide);

/// What every pass that looks for holes binds.
struct HoleResources {
  gpu::Buffer holes;  ///< shared::Hole
  gpu::Buffer grid;
  gpu::Image masks;  ///< The mask atlas.
};

class HoleGrid {
 public:
  /// Uploads the masks. With `all_wide` there is no grid, and every sample asks every hole: what the grid is
  /// measured against.
  HoleGrid(gpu::Context& context, gpu::CommandRunner& runner, const sim::MaskAtlas& masks, bool all_wide);

  /// Plans the frame and makes room. Not between the begin and the end of a recording, and only when the
  /// device is done with what it recorded before. Throws resource_limit.
  void reserve(std::span<const shared::Hole> holes, float time, float rim, float voxel_size,
               std::uint32_t slot_count);
  /// What the frame's constants must say.
  shared::HoleGridFrame frame() const;
  /// Uploads the holes and makes the grid, after the frame's constants and the smoke were uploaded.
  void record(gpu::Recorder& recorder, const gpu::Buffer& frame, const SmokeResources& smoke);

  const HoleResources& resources() const { return resources_; }

 private:
  gpu::Context& context_;
  bool all_wide_;
  gpu::ComputePipeline bricks_, count_, places_, write_, order_;
  HoleResources resources_;
  gpu::Buffer pairs_, counters_;
  HolePlan plan_;
  std::uint32_t slot_count_ = 0;
};

}  // namespace brume::passes
