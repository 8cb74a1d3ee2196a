#include "scenario/smoke_report.hpp"

#include <algorithm>
#include <cmath>

#include "sim/fill.hpp"
#include "sim/walk.hpp"
#include "sim/world.hpp"

namespace brume::scenario {
namespace {

constexpr int kSearchVoxels = 48;
/// Floods to find out whether a place works.
constexpr int kMostFloods = 24;

glm::ivec3 voxel_of(const voxel::GridLayout& layout, glm::vec3 at_world) {
  const glm::vec3 p = (at_world - layout.origin_world) / layout.voxel_size;
  return glm::ivec3(glm::floor(glm::clamp(p, glm::vec3(-1e9f), glm::vec3(1e9f))));
}

glm::vec3 centre_of(const voxel::GridLayout& layout, glm::ivec3 voxel) {
  return layout.origin_world + (glm::vec3(voxel) + 0.5f) * layout.voxel_size;
}

/// The free voxels of a cube's surface around `middle`, nearest first.
std::vector<glm::ivec3> free_shell(const voxel::BitGrid& grid, glm::ivec3 middle, int radius) {
  std::vector<glm::ivec3> shell;
  const Box<int> box{middle - radius, middle + radius + 1};
  const auto add = [&](glm::ivec3 v) {
    if (grid.free(v)) shell.push_back(v);
  };
  for_each_in(Box<int>{{0, box.low.y, box.low.z}, {1, box.high.y, box.high.z}}, [&](glm::ivec3 v) {
    const bool inner = v.y > box.low.y && v.y < box.high.y - 1 && v.z > box.low.z && v.z < box.high.z - 1;
    if (inner) {
      add({box.low.x, v.y, v.z});
      if (radius > 0) add({box.high.x - 1, v.y, v.z});
      return;
    }
    for (int x = box.low.x; x < box.high.x; ++x) add({x, v.y, v.z});
  });
  const auto distance = [&](glm::ivec3 v) {
    const glm::ivec3 off = v - middle;
    return off.x * off.x + off.y * off.y + off.z * off.z;
  };
  std::ranges::stable_sort(shell, {}, distance);
  return shell;
}

bool is_above_solid(const voxel::BitGrid& grid, glm::ivec3 voxel) {
  for (int y = voxel.y - 1; y >= 0; --y)
    if (grid.solid({voxel.x, y, voxel.z})) return true;
  return false;
}

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

std::optional<glm::vec3> nearest_free_place(const voxel::BitGrid& grid, glm::vec3 at_world,
                                            std::uint32_t voxels) {
  const voxel::GridLayout& layout = grid.layout();
  const glm::ivec3 middle = glm::clamp(voxel_of(layout, at_world), glm::ivec3(0), layout.size - 1);
  std::optional<glm::vec3> without_floor;
  int floods = 0;
  for (int radius = 0; radius <= kSearchVoxels && floods < kMostFloods; ++radius) {
    // One place per shell: its neighbours would mostly flood the same space. Under the lowest floor nobody
    // sees it.
    const std::vector<glm::ivec3> shell = free_shell(grid, middle, radius);
    // A way down counts three times: who names a place in the floor means the room above it.
    auto place = std::ranges::find_if(
        shell, [&](glm::ivec3 v) { return v.y >= middle.y - radius / 3 && is_above_solid(grid, v); });
    const bool has_floor = place != shell.end();
    if (!has_floor) place = shell.begin();
    if (place == shell.end() || (!has_floor && without_floor)) continue;
    ++floods;
    if (sim::flood_fill(grid, *place, voxels).size() < voxels) continue;
    if (has_floor) return centre_of(layout, *place);
    without_floor = centre_of(layout, *place);
  }
  return without_floor;
}

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
