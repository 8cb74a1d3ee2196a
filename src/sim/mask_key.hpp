// Which masks a simulation's shots may name. The images themselves are the smoke's (smoke/mask_atlas.hpp).
#pragma once

#include <cstdint>

namespace brume::sim {

/// Maximum number of masks of an atlas.
constexpr std::uint32_t kMaxMasks = 1u << 16;

/// Identifies a set of masks: simulations agree on their holes only if their keys are equal. Masks are not sent.
struct MaskKey {
  std::uint32_t count = 0;
  std::uint64_t hash = 0;
  bool operator==(const MaskKey&) const = default;
};

}  // namespace brume::sim
