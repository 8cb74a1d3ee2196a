// The frame of a scenario at a time.
#pragma once

#include <vector>

#include "planning/frame_input.hpp"
#include "scenario/simulation.hpp"

namespace brume::planning {

/// What a frame shows of a scenario at a time. `holes` keeps the holes that the result refers to. Objects,
/// volumes and decals move with the carriers of the timeline, or with those of `steered` in their place,
/// which has the same names and objects.
FrameInput frame_input(const scenario::Scenario& scenario, const scenario::Simulation& simulation,
                       double seconds, std::vector<shared::Hole>& holes,
                       scenario::VolumeWait wait = scenario::VolumeWait::until_loaded,
                       const std::vector<scene::Carrier>* steered = nullptr);

}  // namespace brume::planning
