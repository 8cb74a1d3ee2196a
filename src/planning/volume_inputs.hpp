// The volumes of a scenario as a frame draws them.
#pragma once

#include <span>

#include "planning/frame_input.hpp"
#include "planning/frame_options.hpp"
#include "scenario/scenario.hpp"

namespace brume::planning {

/// Adds the volumes at a time [s], which stay loaded until another one is read, moved by their carriers, and
/// the light of what glows in them; nothing without Scenario::volumes.
void add_volumes(const scenario::Scenario& scenario, std::span<const scene::Carrier> carriers, double seconds,
                 const FrameOptions& frame, FrameInput& input);

/// Adds one volume as it is at a time [s], and the light of what glows in it. `typical`: its sequence's
/// typical frame.
void add_volume(const scene::VolumeOptions& options, const volumes::VolumeAt& volume,
                const volumes::VolumeFrame& typical, double seconds, FrameInput& input);

/// Puts the light of what glows in order: a frame takes a limited number, the brightest.
void sort_glow(FrameInput& input);

}  // namespace brume::planning
