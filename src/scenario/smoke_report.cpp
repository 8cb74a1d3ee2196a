#include "scenario/smoke_report.hpp"

#include <algorithm>
#include <cmath>

#include "scenario/free_place.hpp"
#include "sim/walk.hpp"
#include "sim/world.hpp"

namespace brume::scenario {
namespace {

/// Where and when a throw of the log goes off.
struct Throw {
  std::uint32_t id = 0, tick = 0;   // when it goes off
  std::optional<glm::ivec3> voxel;  // nothing: it never does
  glm::vec3 target_world{0};        // what it was thrown at
  bool placed = false;              // not thrown from elsewhere
};

std::vector<Throw> throws_of(sim::World& world) {
  const std::span<const sim::Event> events = world.log();
  std::vector<Throw> throws;
  for (std::uint32_t id = 0; id < events.size() && throws.size() < kMostReportedSmokes; ++id) {
    const auto* event = std::get_if<sim::ThrowSmoke>(&events[id]);
    if (!event) continue;
    Throw thrown{
        id, event->tick, {}, glm::vec3(sim::metres_from_position(event->at)), event->from == event->at};
    world.advance_to(event->tick);
    for (const sim::Flight& flight : world.state().flights)
      if (flight.id == id) {
        thrown.tick = flight.detonation_tick;
        thrown.voxel = flight.landing;
      }
    for (const sim::LiveCloud& cloud : world.state().clouds)
      if (cloud.id == id) thrown.voxel = cloud.cloud->origin().source;
    throws.push_back(thrown);
  }
  return throws;
}

SmokeFault fault_of(const SmokeReport& report, const Throw& thrown, const voxel::BitGrid& grid,
                    float duration) {
  if (report.time > double{duration}) return SmokeFault::after_end;
  if (!thrown.voxel) return SmokeFault::outside_grid;
  if (thrown.placed && grid.solid(voxel_of(grid.layout(), thrown.target_world))) return SmokeFault::in_solid;
  return report.voxels < report.budget / 2 ? SmokeFault::confined : SmokeFault::none;
}

SmokeReport report_throw(sim::World& world, const Throw& thrown, const Scenario& scenario) {
  const voxel::GridLayout& layout = scenario.voxels.grid.layout();
  world.advance_to(thrown.tick);
  SmokeReport report;
  report.at_world = thrown.voxel ? centre_of(layout, *thrown.voxel) : thrown.target_world;
  report.time = static_cast<double>(thrown.tick) / world.settings().ticks_per_second;
  report.budget = scenario.timeline.smoke.voxels;
  for (const sim::LiveCloud& cloud : world.state().clouds)
    if (cloud.id == thrown.id) report.voxels = cloud.cloud->parts().fill.size();
  report.fault = fault_of(report, thrown, world.grid(), scenario.timeline.duration);
  if (report.fault == SmokeFault::in_solid) report.at_world = thrown.target_world;
  if (report.fault != SmokeFault::none && report.fault != SmokeFault::after_end)
    report.works_at = nearest_free_place(world.grid(), report.at_world, report.budget / 2);
  return report;
}

std::string to_text(glm::vec3 p) {
  char text[96];
  std::snprintf(text, sizeof text, "%.5g,%.5g,%.5g", static_cast<double>(p.x), static_cast<double>(p.y),
                static_cast<double>(p.z));
  return text;
}

}  // namespace

std::vector<SmokeReport> report_smokes(const Scenario& scenario, sim::World& world) {
  const std::vector<Throw> throws = throws_of(world);
  std::vector<SmokeReport> reports;
  for (std::size_t i = 0; i < throws.size(); ++i) {
    reports.push_back(report_throw(world, throws[i], scenario));
    if (i < scenario.timeline.smokes.size()) reports.back().place = scenario.timeline.smokes[i].place;
  }
  return reports;
}

const char* name_of(SmokeFault fault) {
  switch (fault) {
    case SmokeFault::none:
      return "none";
    case SmokeFault::outside_grid:
      return "outside_grid";
    case SmokeFault::in_solid:
      return "in_solid";
    case SmokeFault::confined:
      return "confined";
    case SmokeFault::after_end:
      return "after_end";
  }
  return "";
}

std::string warning_of(const SmokeReport& report, std::size_t number, const Scenario& scenario) {
  const voxel::GridLayout& layout = scenario.voxels.grid.layout();
  const std::string smoke = (report.place.empty() ? "" : report.place + ": ") + "smoke " +
                            std::to_string(number) + " at " + to_text(report.at_world);
  const std::string works = report.works_at ? "; it fits at " + to_text(*report.works_at) : "";
  // What is wrong, with the numbers to see by how much, and what works.
  switch (report.fault) {
    case SmokeFault::none:
      return "";
    case SmokeFault::outside_grid: {
      const glm::vec3 high = layout.origin_world + glm::vec3(layout.size) * layout.voxel_size;
      return smoke + " is outside the grid, " + to_text(layout.origin_world) + " to " + to_text(high) + works;
    }
    case SmokeFault::in_solid:
      return smoke + " lies in something solid" + works;
    case SmokeFault::confined:
      return smoke + " fills " + std::to_string(report.voxels) + " of " + std::to_string(report.budget) +
             " voxels" + works;
    case SmokeFault::after_end: {
      char text[96];
      std::snprintf(text, sizeof text, " goes off at %.3g s, after the end at %.3g s", report.time,
                    double{scenario.timeline.duration});
      return smoke + text;
    }
  }
  return "";
}

}  // namespace brume::scenario
