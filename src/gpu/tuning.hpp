// What suits a device, where the same frame can be computed by different means.
#pragma once

#include <cstdint>

#include "gpu/device_list.hpp"

namespace brume::gpu {

/// Made once, with the Context. The defaults are for GPUs.
struct Tuning {
  /// Surfaces are drawn twice, so that hidden ones write no material: faster where a fragment costs more than
  /// a vertex.
  bool depth_first = true;
  /// Samples along the longer axis of a minified pixel of a surface, in [1, 16]. With 8, floors stay sharp
  /// towards the horizon, and 16 looks the same.
  float surface_anisotropy = 8;
  /// Steps of a march whose samples are read before any of them is used (lib/media_block.glsl).
  std::uint32_t march_block_steps = 4;
  /// Rays march by one pipeline in tiles that meet holes, and by another in tiles that do not. A driver
  /// without a GPU runs the code for holes even where there are none; on a GPU the workgroups that end at
  /// once cost more.
  bool split_march_by_holes = false;
  /// One workgroup lights all texels of a brick in turn, in place of a thread for each: without a GPU, idle
  /// threads cost as much as busy ones.
  bool light_in_one_group = false;
  /// The pass that shades also displays, where nothing comes between: a pass of its own costs next to nothing
  /// without a GPU.
  bool shade_displays = true;
};

Tuning tuning_for(DeviceKind kind);

}  // namespace brume::gpu
