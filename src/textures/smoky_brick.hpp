// A brick in which shaders find smoke.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/type_precision.hpp>
#include <span>

#include "smoke/smoke_volume.hpp"
#include "smoke/texel_set.hpp"

namespace brume::textures {

struct SmokyBrick {
  std::uint32_t slot = 0;
  /// Texels with smoke, and the corners of cells at walls with smoke, which may come from voxels of another
  /// brick.
  smoke::TexelSet smoke;
  /// The displacement of the noise at each texel, or at every other one along each axis [m]; empty where
  /// there is none.
  std::span<const glm::u16vec4> displacements;
};

/// SmokyBrick::smoke of a slot in use.
smoke::TexelSet find_smoke(const smoke::SmokeVolume& volume, std::uint32_t slot);

}  // namespace brume::textures
