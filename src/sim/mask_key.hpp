// Identifies the masks that a simulation's shots refer to. The images are in smoke/mask_atlas.hpp.
#pragma once

#include <cstdint>

namespace brume::sim {

/// Maximum number of masks in an atlas.
constexpr std::uint32_t kMaxMasks = 1u << 16;

/// Identifies a set of masks. Two simulations agree on their holes only if their keys are equal; masks
/// themselves are never sent.
struct MaskKey {
  std::uint32_t count = 0;
  std::uint64_t hash = 0;
  bool operator==(const MaskKey&) const = default;
};

}  // namespace brume::sim
