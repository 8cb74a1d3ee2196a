// Line of sight between two points picked in the window.
#pragma once

#include <optional>

#include "scenario/scenario.hpp"
#include "scenario/simulation.hpp"
#include "smoke/sight.hpp"

namespace brume::viewer {

/// Up to two end points.
struct Probe {
  std::optional<glm::vec3> a_world, b_world;

  /// Sets the first end, at the next call the second, then removes both.
  void pick(glm::vec3 place_world);
};

struct ProbeResult {
  float optical_depth = 0;
  float transmittance = 1;      ///< exp(-optical_depth); 0 behind a wall.
  std::optional<float> wall_m;  ///< Distance from the first end to the first wall between them [m].
};

/// Evaluates a probe that has both ends, with the smoke of the current tick and the holes at `seconds`.
Result<ProbeResult> evaluate(const Probe& probe, const scenario::Scenario& scenario,
                             const scenario::Simulation& simulation, double seconds);

}  // namespace brume::viewer
