// Volumes as a frame draws them.
#pragma once

#include "planning/frame_input.hpp"
#include "volumes/volumes.hpp"

namespace brume::planning {

/// Adds one volume as it is at a time [s], and the light of what glows in it. `typical`: its sequence's
/// typical frame.
void add_volume(const scene::VolumeOptions& options, const volumes::VolumeAt& volume,
                const volumes::VolumeFrame& typical, double seconds, FrameInput& input);

/// Adds only the light of what glows in a volume, which belongs to the next one of `input`.
void add_glow(const scene::VolumeOptions& options, const volumes::VolumeAt& volume, double seconds,
              FrameInput& input);

/// Puts the light of what glows in order: a frame takes a limited number, the brightest.
void sort_glow(FrameInput& input);

}  // namespace brume::planning
