// How long a smoke hides two points of a timeline from each other, and how many shots it takes to see.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "apps/cli/parse.hpp"
#include "smoke/sight.hpp"
#include "scenario/simulation.hpp"

namespace brume::cli {

struct SightLine {
  glm::vec3 from_world{0}, to_world{0};
  float threshold = 3;  ///< Optical depth above which smoke hides.
};

enum class HiddenBy { nothing, wall, smoke };
/// "nothing", "wall" or "smoke".
const char* name_of(HiddenBy by);

/// What the line is at one sample.
struct SightSample {
  HiddenBy hidden_by = HiddenBy::nothing;
  float optical_depth = 0;
  std::optional<smoke::SightWall> wall;
};

SightSample look(const scenario::Scenario& scenario, const scenario::Simulation& simulation, const SightLine& line);

/// Ticks one after the other at which the same hides, as times [s]: from the first of them to the next tick
/// after the last.
struct HiddenInterval {
  double begin = 0, end = 0;
  HiddenBy by = HiddenBy::smoke;
  float most_depth = 0;
};

struct Coverage {
  std::vector<HiddenInterval> intervals;  ///< By time, apart or hidden by different things.
  double hidden_seconds = 0;
};

/// Looks at every tick in [times.begin, times.end). Throws Error as scenario::Simulation::create fails, and
/// Interrupted.
Coverage coverage_of(const scenario::Scenario& scenario, const SightLine& line, const TimeRange& times);

/// Shots from one end of the line towards the other, besides those of the timeline.
struct Volley {
  unsigned count = 1;
  double first_time = 0, every = 0.1;  ///< [s]
  double spread_degrees = 0;           ///< They go to points of a disk around the line, evenly, none beyond.
};

/// What the first shots of a volley do: all that are fired up to `time`.
struct ShotResult {
  double time = 0;  ///< When the last of them is fired [s].
  float least_depth =
      0;  ///< At the ticks at which it would be hidden without them, until that one's hole closes.
  bool seen = false;  ///< Whether nothing hides at one of those ticks.
};

/// One shot, two shots, and so on until it is seen or all are fired; looks no later than `end` [s]. Nothing
/// where it is not hidden in that time anyway.
std::vector<ShotResult> fire(const scenario::Scenario& scenario, const SightLine& line, const Volley& volley,
                             double end);

}  // namespace brume::cli
