// How long smoke hides two points of a timeline from each other, and how many shots clear the line of sight.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "apps/command_line/parse.hpp"
#include "scenario/simulation.hpp"
#include "smoke/sight.hpp"

namespace brume::cli {

struct SightLine {
  glm::vec3 from_world{0}, to_world{0};
  float threshold = 3;  ///< Optical depth above which smoke hides the far end.
  bool drawn = false;   ///< Through the smoke of pictures.
};

enum class HiddenBy { nothing, wall, smoke };
/// "nothing", "wall" or "smoke".
const char* name_of(HiddenBy by);

/// The state of a line of sight at one tick.
struct SightSample {
  HiddenBy hidden_by = HiddenBy::nothing;
  float optical_depth = 0;
  std::optional<smoke::SightWall> wall;
};

SightSample sample_sight(const scenario::Scenario& scenario, const scenario::Simulation& simulation,
                         const SightLine& line);

/// Consecutive ticks at which the same thing hides the line [s]: from the first of them to the tick after the
/// last.
struct HiddenInterval {
  double begin = 0, end = 0;
  HiddenBy by = HiddenBy::smoke;
  float max_optical_depth = 0;
};

struct Coverage {
  std::vector<HiddenInterval> intervals;  ///< Sorted by time; neighbours are apart or differ in `by`.
  double hidden_seconds = 0;
};

/// Samples every tick in [times.begin, times.end). Throws Error if scenario::Simulation::create fails, and
/// Interrupted on a signal.
Coverage coverage_of(const scenario::Scenario& scenario, const SightLine& line, const TimeRange& times);

/// Shots from one end of the line towards the other, in addition to the timeline's own.
struct Volley {
  unsigned count = 1;
  double first_time = 0, every = 0.1;  ///< [s]
  double spread_degrees = 0;           ///< Half-angle of the cone that the shots fill evenly.
};

/// The effect of the first shots of a volley: all that are fired up to `time`.
struct ShotResult {
  double time = 0;  ///< When the last of them is fired [s].
  /// Over the ticks at which the line is hidden without the shots, until the last shot's hole closes.
  float min_optical_depth = 0;
  bool visible = false;  ///< Whether nothing hides the line at one of those ticks.
};

/// Results for one shot, two shots and so on, until the far end is visible or all are fired; samples no later
/// than `end` [s]. Empty if nothing hides the line in that time even without shots.
std::vector<ShotResult> fire(const scenario::Scenario& scenario, const SightLine& line, const Volley& volley,
                             double end);

}  // namespace brume::cli
