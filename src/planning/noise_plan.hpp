// The noise of a frame: what advects it, and where.
#pragma once

#include <optional>

#include "core/frame_memory.hpp"
#include "planning/input_key.hpp"
#include "smoke/noise_motion.hpp"

namespace brume::planning {

struct NoisePlan {
  smoke::NoiseMotion motion;
  /// The slots whose noise the frame advects; empty: all of its slots.
  std::optional<FrameVector<std::uint32_t>> slots_due = std::nullopt;
  /// Time-sliced noise catches up: it changes, though its inputs may not.
  bool catches_up = false;
  /// It moves otherwise than in the frame before, though the time may be the same.
  bool motion_changed = false;
};

/// Adds what moves the noise.
inline void add_motion(InputKey& key, const smoke::NoiseMotion& motion) {
  key.add_list(motion.clouds);
  key.add_list(motion.impulses);
}

}  // namespace brume::planning
