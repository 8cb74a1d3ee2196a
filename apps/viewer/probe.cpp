#include "apps/viewer/probe.hpp"

#include <cmath>

#include "smoke/holes.hpp"

namespace brume::viewer {

void Probe::pick(glm::vec3 place_world) {
  if (b_world) {
    *this = {};
  } else if (a_world) {
    b_world = place_world;
  } else {
    a_world = place_world;
  }
}

Result<ProbeResult> evaluate(const Probe& probe, const scenario::Scenario& scenario,
                             const scenario::Simulation& simulation, double seconds) {
  const auto holes = smoke::make_holes(simulation.world().state(), &scenario.masks);
  smoke::SightSettings settings;
  settings.extinction = scenario.timeline.smoke.extinction;
  settings.masks = &scenario.masks;
  const smoke::Sight sight(simulation.volume(), simulation.world().solids().sight, holes,
                           static_cast<float>(seconds), settings);
  const auto depth = sight.optical_depth(*probe.a_world, *probe.b_world);
  if (!depth) return depth.failure();
  const auto wall = sight.first_wall(*probe.a_world, *probe.b_world);
  if (!wall) return wall.failure();
  ProbeResult result;
  result.optical_depth = *depth;
  result.transmittance = *wall ? 0 : std::exp(-*depth);
  if (*wall) result.wall_m = (*wall)->distance;
  return result;
}

}  // namespace brume::viewer
