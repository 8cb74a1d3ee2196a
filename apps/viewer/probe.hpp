// Line of sight between two points that were picked in the picture.
#pragma once

#include <optional>

#include "smoke/sight.hpp"
#include "scenario/simulation.hpp"
#include "scenario/scenario.hpp"

namespace brume::viewer {

/// Two ends, or one while the second is still to be picked.
struct Probe {
  std::optional<glm::vec3> a_world, b_world;

  /// The next step: sets the first end, then the second, then takes both away.
  void pick(glm::vec3 place_world);
};

struct ProbeAnswer {
  float optical_depth = 0;
  float transmittance = 1;      ///< exp(-optical_depth); 0 behind a wall.
  std::optional<float> wall_m;  ///< From the first end to a wall between them [m].
};

/// What a probe with both ends sees at the simulation's tick, with the holes of `seconds`.
Result<ProbeAnswer> ask(const Probe& probe, const scenario::Scenario& scenario, const scenario::Simulation& simulation,
                        double seconds);

}  // namespace brume::viewer
