// The volumes of a scenario as a frame draws them.
#pragma once

#include "planning/frame_input.hpp"
#include "scenario/scenario.hpp"

namespace brume::render {

/// The volumes at a time [s], which stay loaded until another one is read; none without Scenario::volumes.
std::vector<planning::VolumeInput> volume_inputs(const scenario::Scenario& scenario, double seconds,
                                                 scenario::VolumeWait wait);

}  // namespace brume::render
