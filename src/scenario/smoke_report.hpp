// What becomes of the smokes of a scenario: where and when they go off, how much they fill, and what is
// wrong.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scenario/scenario.hpp"
#include "sim/world.hpp"

namespace brume::scenario {

enum class SmokeFault {
  none,
  outside_grid,  ///< Never goes off: there are no voxels where it is thrown.
  in_solid,      ///< Placed inside something solid; it goes off beside it.
  confined,      ///< Fills less than half of its voxels: it is shut in.
  after_end,     ///< Goes off after the timeline ends.
};

struct SmokeReport {
  glm::vec3 at_world{0};     ///< Where it goes off, or for the two faults of places should have [m].
  double time = 0;           ///< When it goes off [s].
  std::uint32_t voxels = 0;  ///< How many it fills when grown.
  std::uint32_t budget = 0;  ///< SmokeOptions::voxels.
  SmokeFault fault = SmokeFault::none;
  /// For faults of places: the nearest place found where it fills all of its voxels.
  std::optional<glm::vec3> works_at;
  std::string place = {};  ///< SmokeEvent::place.
};

/// At most this many smokes are reported, the first ones.
constexpr std::size_t kMostReportedSmokes = 64;

/// "none", "outside_grid", "in_solid", "confined" or "after_end".
const char* name_of(SmokeFault fault);

/// Plays a world with the timeline's events up to the last of its smokes, and leaves it there.
std::vector<SmokeReport> report_smokes(const Scenario& scenario, sim::World& world);

/// One line for people: what is wrong with smoke `number`, counted from 1, and what works. Empty where
/// nothing is.
std::string warning_of(const SmokeReport& report, std::size_t number, const Scenario& scenario);

}  // namespace brume::scenario
