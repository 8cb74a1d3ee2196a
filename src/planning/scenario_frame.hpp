// The frame of a scenario at a time.
#pragma once

#include <vector>

#include "planning/frame_input.hpp"
#include "scenario/simulation.hpp"

namespace brume::planning {

struct FrameOptions {
  scenario::VolumeWait wait = scenario::VolumeWait::until_loaded;
  /// In place of the timeline's carriers; of the same names and objects. null: those of the timeline.
  const std::vector<scene::Carrier>* steered = nullptr;
  /// Whether volumes that the timeline shows as particles are; else they are volumes like others.
  bool particles = true;
};

/// What a frame shows of a scenario at a time. `holes` keeps the holes that the result refers to. Objects,
/// volumes and decals move with the carriers.
FrameInput frame_input(const scenario::Scenario& scenario, const scenario::Simulation& simulation,
                       double seconds, std::vector<shared::Hole>& holes, const FrameOptions& options = {});

}  // namespace brume::planning
