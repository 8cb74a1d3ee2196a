#include "gpu/tuning.hpp"

namespace brume::gpu {

Tuning tuning_for(DeviceKind kind) {
  if (kind != DeviceKind::cpu) return {};
  Tuning tuning;
  tuning.depth_first = false;
  tuning.surface_anisotropy = 1;  // 8 would double the time of the pass
  tuning.march_block_steps = 1;
  tuning.split_march_by_holes = true;
  tuning.light_in_one_group = true;
  tuning.shade_displays = false;
  return tuning;
}

}  // namespace brume::gpu
