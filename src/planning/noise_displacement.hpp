// The displacement of the smoke's noise at a time, as shaders/noise_advection.comp stores it, on the CPU.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "shared/frame.h"
#include "sim/state.hpp"
#include "smoke/smoke_volume.hpp"

namespace brume::planning {

/// By texel of the volume's slots, slot * kTexelsPerBrick + x + 10 (y + 10 z), `seconds` after tick 0 [m]:
/// the noise at a point is that of the point + its displacement. 0 where no texel next to it in its brick
/// holds smoke. `volume` holds the smoke of the state.
std::vector<glm::vec3> noise_displacement(const smoke::SmokeVolume& volume, const sim::State& state,
                                          const shared::SmokeLook& look, double seconds, double swirl_period);

}  // namespace brume::planning
