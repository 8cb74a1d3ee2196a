// The volumes of a scenario in a frame.
#pragma once

#include <span>

#include "planning/frame_input.hpp"
#include "scenario/frame_options.hpp"
#include "scenario/scenario.hpp"

namespace brume::scenario {

/// Adds the volumes at a time [s], which stay loaded until another one is read, moved by their carriers, and
/// the light of what glows in them; nothing without Scenario::volumes.
void add_volumes(const Scenario& scenario, std::span<const scene::Carrier> carriers, double seconds,
                 const FrameOptions& frame, planning::FrameInput& input);

}  // namespace brume::scenario
