// The displacement of the smoke's noise at a time, as shaders/noise_advection.comp stores it, on the CPU.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "shared/frame.h"
#include "sim/state.hpp"
#include "smoke/cloud_growth.hpp"
#include "smoke/noise_motion.hpp"
#include "smoke/smoke_volume.hpp"

namespace brume::smoke {

/// A part's growth at a texel of its brick, [0, 10] along each axis, and its weight, from the points of
/// shared/noise_advection.h.
glm::vec4 growth_at(PartDisplacements points, glm::ivec3 local);

class NoiseDisplacement {
 public:
  /// `seconds` after tick 0. `volume` holds the smoke of the state, must outlive this and stay as it is.
  NoiseDisplacement(const SmokeVolume& volume, const sim::State& state, const shared::SmokeLook& look,
                    double seconds, double swirl_period);

  /// Writes the displacement of a brick's texels [m], x + 10 (y + 10 z): the noise at a point is taken at the
  /// point + its displacement. 0 where no texel next to it in its brick holds smoke.
  void write(std::uint32_t slot, std::span<glm::vec3, shared::kTexelsPerBrick> out) const;

 private:
  glm::vec3 by_clouds(std::uint32_t slot, glm::ivec3 local, glm::vec3 p_world) const;

  const SmokeVolume& volume_;
  float swirl_, swirl_width_;
  NoiseMotion motion_;
  CloudGrowth growth_;
};

}  // namespace brume::smoke
