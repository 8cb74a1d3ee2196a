// What a flood decides for each voxel of a cloud.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/block_set.hpp"

namespace brume::sim {

/// By rank in the fill.
struct FillValues {
  std::vector<std::uint32_t> distances;  ///< Length of the flood's path.
  std::vector<std::uint8_t> survival;    ///< Cloud::survival.
  std::vector<std::uint8_t> lag;         ///< Fraction of the distance, / 2^kLagBits, that Cloud::reach adds.
};
constexpr int kLagBits = 10;

/// The values for the fill of a cloud whose grenade detonated at `source`.
FillValues fill_values(glm::ivec3 source, std::uint32_t detonation_tick, const BlockSet& fill,
                       std::vector<std::uint32_t> distances);

/// Front distance at which smoke reaches a voxel.
inline std::uint32_t reach_of(std::uint32_t distance, std::uint8_t lag) {
  return distance + static_cast<std::uint32_t>((std::uint64_t{distance} * lag) >> kLagBits);
}

}  // namespace brume::sim
