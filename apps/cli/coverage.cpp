#include "apps/cli/coverage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "apps/command_line/console.hpp"
#include "core/progress.hpp"
#include "planning/smoke_look.hpp"

namespace brume::cli {
namespace {

/// The target of shot i: points of a disk around the far end, spread evenly by the golden angle (Vogel 1979).
glm::vec3 aim(const SightLine& line, const Volley& volley, unsigned i) {
  const glm::dvec3 from(line.from_world), segment = glm::dvec3(line.to_world) - from;
  const double length = glm::length(segment);
  const glm::dvec3 ahead = segment / length;
  const glm::dvec3 aside =
      glm::normalize(glm::cross(ahead, std::abs(ahead.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0)));
  const double radius =
      std::tan(volley.spread_degrees * std::numbers::pi / 180) * length * std::sqrt((i + 0.5) / volley.count);
  const double angle = 2.399963229728653 * i;
  return glm::vec3(from + segment +
                   radius * (std::cos(angle) * aside + std::sin(angle) * glm::cross(ahead, aside)));
}

std::vector<scene::ShotEvent> shots_of(const SightLine& line, const Volley& volley) {
  std::vector<scene::ShotEvent> shots;
  for (unsigned i = 0; i < volley.count; ++i) {
    scene::ShotEvent shot;
    shot.time = volley.first_time + i * volley.every;
    shot.from_world = line.from_world;
    shot.toward_world = aim(line, volley, i);
    shot.place = "shot " + std::to_string(i + 1) + " of --shots";
    shots.push_back(shot);
  }
  return shots;
}

double tick_seconds(const scenario::Simulation& simulation) {
  return 1.0 / simulation.world().settings().ticks_per_second;
}

/// Calls visit(simulation, time) at every tick whose time is in [begin, end).
template <typename Visit>
void at_every_tick(const scenario::Scenario& scenario, double begin, double end, const Visit& visit) {
  const auto simulation = scenario::Simulation::create(scenario).value_or_throw();
  const double step = tick_seconds(*simulation);
  Progress job("ticks", static_cast<std::uint64_t>(std::ceil(std::max(end - begin, 0.0) / step)));
  for (auto tick = static_cast<std::uint64_t>(std::ceil(begin / step - 1e-9));
       static_cast<double>(tick) * step < end - 1e-9; ++tick) {
    stop_if_interrupted();
    simulation->advance_to(static_cast<double>(tick) * step);
    visit(*simulation, static_cast<double>(tick) * step);
    job.advance();
  }
}

SightSample sample_of(const smoke::Sight& sight, const SightLine& line) {
  SightSample sample;
  sample.optical_depth = sight.optical_depth(line.from_world, line.to_world).value_or_throw();
  sample.wall = sight.first_wall(line.from_world, line.to_world).value_or_throw();
  sample.hidden_by = sample.wall                             ? HiddenBy::wall
                     : sample.optical_depth > line.threshold ? HiddenBy::smoke
                                                             : HiddenBy::nothing;
  return sample;
}

}  // namespace

const char* name_of(HiddenBy by) {
  return by == HiddenBy::wall ? "wall" : by == HiddenBy::smoke ? "smoke" : "nothing";
}

SightSample sample_sight(const scenario::Scenario& scenario, const scenario::Simulation& simulation,
                         const SightLine& line) {
  const smoke::Field& field = simulation.field();
  const scene::SmokeOptions& smoke = scenario.timeline.smoke;
  return sample_of(*field.sight(planning::sight_look(smoke, field.layout().voxel_size, line.drawn)), line);
}

Coverage coverage_of(const scenario::Scenario& scenario, const SightLine& line, const TimeRange& times) {
  Coverage coverage;
  at_every_tick(scenario, times.begin, times.end, [&](const scenario::Simulation& simulation, double time) {
    const SightSample sample = sample_sight(scenario, simulation, line);
    if (sample.hidden_by == HiddenBy::nothing) return;
    const double next = std::min(time + tick_seconds(simulation), times.end);
    coverage.hidden_seconds += next - time;
    auto& intervals = coverage.intervals;
    const bool continues = !intervals.empty() && intervals.back().by == sample.hidden_by &&
                           std::abs(intervals.back().end - time) < 1e-9;
    if (!continues) intervals.push_back({time, next, sample.hidden_by, 0});
    intervals.back().end = next;
    float& deepest = intervals.back().max_optical_depth;
    deepest = std::max(deepest, sample.optical_depth);
  });
  return coverage;
}

std::vector<ShotResult> fire(const scenario::Scenario& scenario, const SightLine& line, const Volley& volley,
                             double end) {
  const std::vector<scene::ShotEvent> shots = shots_of(line, volley);
  const auto closed = [](const scene::ShotEvent& s) {
    return s.time + double{s.times.reach} + double{s.times.expand} + double{s.times.stay} +
           double{s.times.fade};
  };
  std::vector<bool> hidden;
  at_every_tick(scenario, volley.first_time, std::min(end, closed(shots.back())),
                [&](const scenario::Simulation& simulation, double) {
                  hidden.push_back(sample_sight(scenario, simulation, line).hidden_by != HiddenBy::nothing);
                });
  std::vector<ShotResult> results;
  if (std::find(hidden.begin(), hidden.end(), true) == hidden.end()) return results;

  scenario::Scenario with_shots = scenario;
  auto& all = with_shots.timeline.shots;
  for (const scene::ShotEvent& shot : shots) {
    // The timeline's shots are sorted by time.
    const auto later = [&](const scene::ShotEvent& other) { return other.time > shot.time; };
    all.insert(std::find_if(all.begin(), all.end(), later), shot);
    ShotResult result{shot.time, std::numeric_limits<float>::max(), false};
    std::size_t tick = 0;
    at_every_tick(with_shots, volley.first_time, std::min(end, closed(shot)),
                  [&](const scenario::Simulation& simulation, double) {
                    if (!hidden[tick++]) return;
                    const SightSample sample = sample_sight(scenario, simulation, line);
                    result.min_optical_depth = std::min(result.min_optical_depth, sample.optical_depth);
                    result.visible |= sample.hidden_by == HiddenBy::nothing;
                  });
    if (shot.time < end) results.push_back(result);
    if (result.visible) break;
  }
  return results;
}

}  // namespace brume::cli
