// The displacement of the noise in all bricks of a volume.
#pragma once

#include <vector>

#include "smoke/noise_displacement.hpp"

namespace brume::smoke {

/// slot * kTexelsPerBrick + texel
inline std::vector<glm::vec3> displacements_of(const NoiseDisplacement& displacement,
                                               const SmokeVolume& volume) {
  std::vector<glm::vec3> out(std::size_t{volume.slot_count()} * shared::kTexelsPerBrick);
  for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot)
    displacement.write(
        slot, std::span<glm::vec3, shared::kTexelsPerBrick>(
                  out.data() + std::size_t{slot} * shared::kTexelsPerBrick, shared::kTexelsPerBrick));
  return out;
}

}  // namespace brume::smoke
