#include <cmath>
#include <cstdio>

#include "apps/cli/command.hpp"
#include "apps/cli/coverage.hpp"
#include "apps/cli/query_sense.hpp"
#include "apps/cli/scene_options.hpp"
#include "apps/cli/summary.hpp"
#include "apps/command_line/console.hpp"
#include "apps/command_line/json.hpp"
#include "apps/command_line/parse.hpp"
#include "core/error.hpp"
#include "core/log.hpp"
#include "core/utf8.hpp"
#include "smoke/sight.hpp"

namespace brume::cli {
namespace {

struct QueryOptions {
  std::string timeline, from, to, times, json;
  double time = -1, shots_at = -1, shots_every = 0.1, spread = 0;
  SceneOptions scene;
  SenseOptions sense;
  std::string expect;
  float threshold = 3;
  unsigned shots = 0;
  bool report = false, drawn = false;
};

std::string number(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

glm::vec3 parse_end(const std::string& option, const std::string& text) {
  const glm::vec3 p = parse_point(option, text);
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(p[axis]) > smoke::kMaxSightMetres)
      throw Error(ErrorCode::usage, option + " '" + text + "': expected coordinates within 16384 m");
  }
  return p;
}

void check_options(const Arguments& arguments, const QueryOptions& options) {
  if (options.report) {
    arguments.refuse("--time", "is for a single sample; with --report use --times, such as --times 0-6");
  } else {
    for (const char* option : {"--times", "--shots", "--shots-at", "--shots-every", "--spread"})
      arguments.refuse(option, "requires --report; add it");
  }
  if (!options.report && options.time < 0)
    throw Error(ErrorCode::usage, "expected a time, such as --time 3, or --report for all of them");
  if (options.shots == 0)
    for (const char* option : {"--shots-at", "--shots-every", "--spread"})
      arguments.refuse(option, "requires --shots, such as --shots 3");
}

/// Prints one line per field: its name and its value.
void print_fields(const std::vector<std::pair<std::string, std::string>>& fields) {
  for (const auto& [name, value] : fields) print(name + std::string(16 - name.size(), ' ') + value + "\n");
}

/// Warns of ends where nothing can be.
void check_ends(const voxel::BitGrid& grid, const SightLine& line) {
  const auto check = [&](const char* option, glm::vec3 p) {
    const voxel::GridLayout& layout = grid.layout();
    const glm::vec3 at = glm::floor((p - layout.origin_world) / layout.voxel_size);
    const bool inside = glm::all(glm::greaterThanEqual(at, glm::vec3(0))) &&
                        glm::all(glm::lessThan(at, glm::vec3(layout.size)));
    if (inside && grid.solid(glm::ivec3(at))) log_warning(std::string(option) + " lies in something solid");
  };
  check("--from", line.from_world);
  check("--to", line.to_world);
}

/// Exit code 7 unless the result is what --expect states.
void judge(const QueryOptions& options, bool visible) {
  if (options.expect.empty() || (options.expect == "visible") == visible) return;
  throw Error(ErrorCode::comparison_failed,
              std::string("--to is ") + (visible ? "visible" : "hidden") + ", expected " + options.expect);
}

void print_sample(const QueryOptions& options, const scenario::Scenario& scenario, const SightLine& line) {
  // Ask the simulation at that time.
  const auto simulation = scenario::Simulation::create(scenario).value_or_throw();
  simulation->advance_to(options.time);
  check_ends(simulation->world().grid(), line);
  const SightSample sample = sample_sight(scenario, *simulation, line);
  const double transmittance = std::exp(-double{sample.optical_depth});
  const float distance = glm::length(line.to_world - line.from_world);
  const bool visible = sample.hidden_by == HiddenBy::nothing;
  // Report as JSON and as text.
  if (!options.json.empty()) {
    Json first = nullptr;
    if (const auto& wall = sample.wall)
      first = Json{{"voxel", Json::list({wall->voxel.x, wall->voxel.y, wall->voxel.z})},
                   {"distance", wall->distance}};
    write_json(options.json, {{"timeline", options.timeline},
                              {"time", options.time},
                              {"tick", simulation->world().tick()},
                              {"from", point_json(line.from_world)},
                              {"to", point_json(line.to_world)},
                              {"threshold", line.threshold},
                              {"extinction", scenario.timeline.smoke.extinction},
                              {"drawn", line.drawn},
                              {"visible", visible},
                              {"hidden_by", visible ? Json(nullptr) : Json(name_of(sample.hidden_by))},
                              {"optical_depth", sample.optical_depth},
                              {"transmittance", transmittance},
                              {"distance", distance},
                              {"first_solid", first}});
  }
  if (options.json == "-") return judge(options, visible);
  print_fields(
      {{"visible", visible ? "yes" : std::string("no, hidden by ") + name_of(sample.hidden_by)},
       {"optical depth", number("%.3f", double{sample.optical_depth})},
       {"transmittance", number("%.4g", transmittance)},
       {"distance", number("%.2f m", double{distance})},
       {"first solid", sample.wall ? number("after %.2f m", double{sample.wall->distance}) : "none"}});
  judge(options, visible);
}

Json coverage_json(const Coverage& coverage) {
  Json intervals = Json::list({});
  for (const HiddenInterval& i : coverage.intervals)
    intervals.push_back(Json{{"begin", i.begin},
                             {"end", i.end},
                             {"by", name_of(i.by)},
                             {"max_optical_depth", i.max_optical_depth}});
  return {{"hidden_seconds", coverage.hidden_seconds}, {"intervals", intervals}};
}

Json shots_json(const std::vector<ShotResult>& shots) {
  Json each = Json::list({});
  for (const ShotResult& shot : shots)
    each.push_back(
        Json{{"time", shot.time}, {"min_optical_depth", shot.min_optical_depth}, {"visible", shot.visible}});
  const bool visible = shots.empty() || shots.back().visible;
  return {{"visible_after", visible ? Json(shots.size()) : Json(nullptr)}, {"each", each}};
}

void print_coverage(const Coverage& coverage, const TimeRange& times) {
  print("hidden for " + number("%.2f", coverage.hidden_seconds) + " of " +
        number("%.2f s", times.end - times.begin) + "\n");
  if (coverage.intervals.empty()) return;
  print(" begin [s]   end [s]  hidden by  max optical depth\n");
  for (const HiddenInterval& i : coverage.intervals) {
    char line[120];
    std::snprintf(line, sizeof line, "%10.2f %9.2f  %-9s  %17.3f\n", i.begin, i.end, name_of(i.by),
                  double{i.max_optical_depth});
    print(line);
  }
}

void print_shots(const std::vector<ShotResult>& shots, unsigned count) {
  if (shots.empty()) return print("visible even without the shots\n");
  print((shots.back().visible ? "visible after " : "still hidden after ") + std::to_string(shots.size()) +
        " of " + std::to_string(count) + " shots\n");
  print("  shots  last fired [s]  min optical depth\n");
  for (std::size_t i = 0; i < shots.size(); ++i) {
    char line[120];
    std::snprintf(line, sizeof line, "%7zu %15.2f  %17.3f\n", i + 1, shots[i].time,
                  double{shots[i].min_optical_depth});
    print(line);
  }
}

void report_coverage(const QueryOptions& options, const scenario::Scenario& scenario, const SightLine& line) {
  const TimeRange times = options.times.empty() ? TimeRange{0, double{scenario.timeline.duration}}
                                                : parse_times("--times", options.times);
  check_ends(scenario.voxels.grid, line);
  const Coverage coverage = coverage_of(scenario, line, times);
  std::vector<ShotResult> shots;
  if (options.shots > 0) {
    const double at = options.shots_at < 0 ? times.begin : options.shots_at;
    if (at < times.begin || at > times.end) {
      char message[128];
      std::snprintf(message, sizeof message, "--shots-at: %g s is outside of --times %g-%g", at, times.begin,
                    times.end);
      throw Error(ErrorCode::usage, message);
    }
    shots = fire(scenario, line, {options.shots, at, options.shots_every, options.spread}, times.end);
  }
  if (!options.json.empty()) {
    Json report{{"timeline", options.timeline},
                {"times", Json::list({times.begin, times.end})},
                {"from", point_json(line.from_world)},
                {"to", point_json(line.to_world)},
                {"threshold", line.threshold},
                {"extinction", scenario.timeline.smoke.extinction},
                {"drawn", line.drawn}};
    report.update(coverage_json(coverage));
    if (options.shots > 0) report.set("shots", shots_json(shots));
    write_json(options.json, report);
  }
  if (options.json != "-") {
    print_coverage(coverage, times);
    if (options.shots > 0) print_shots(shots, options.shots);
  }
  // A report asks whether the target was hidden at all.
  judge(options, coverage.intervals.empty());
}

/// Answers --sense, which has options of its own.
void query_tank(const Arguments& arguments, const QueryOptions& options, Outputs& outputs) {
  for (const char* option :
       {"--from", "--to", "--time", "--times", "--threshold", "--report", "--shots", "--shots-at",
        "--shots-every", "--spread", "--expect", "--voxel", "--scale", "--drawn"})
    arguments.refuse(option, "is for lines of sight; remove it, or --sense");
  SenseOptions sense = options.sense;
  sense.input = options.timeline;
  sense.json = options.json;
  sense_tank(sense, outputs);
}

void query(const Arguments& arguments, const QueryOptions& options, Outputs& outputs) {
  if (arguments.given("--sense")) return query_tank(arguments, options, outputs);
  for (const char* option : {"--size", "-o"}) arguments.refuse(option, "requires --sense; add it");
  for (const auto& [option, value] : {std::pair("--from", &options.from), {"--to", &options.to}})
    if (value->empty())
      throw Error(ErrorCode::usage, std::string(option) + " is required, such as " + option + " 0,1.7,3");
  const SightLine line{parse_end("--from", options.from), parse_end("--to", options.to), options.threshold,
                       options.drawn};
  check_options(arguments, options);
  if (!options.times.empty()) parse_times("--times", options.times);
  if (options.shots > 0 && line.from_world == line.to_world)
    throw Error(ErrorCode::usage, "--shots: --from and --to are the same point; give two distinct ones");
  outputs.reads(to_path(options.timeline));
  outputs.writes("--json", to_path(options.json), FileKind::json);
  const scenario::Scenario scenario =
      load_with_options(options.timeline, "", parse_scene_options(options.scene));
  outputs.reads(scenario::files_of(scenario));
  stop_if_interrupted();
  if (options.report) {
    report_coverage(options, scenario, line);
  } else {
    print_sample(options, scenario, line);
  }
}

constexpr const char* kQueryExamples =
    "  # Does A see B after 3.2 s?\n"
    "  brume query scenes/demo.toml --from -5.2,1.35,10.8 --to -1.75,1.65,-3 --time 3.2\n"
    "  # When is B hidden between 1 and 3 s? As JSON\n"
    "  brume query scenes/demo.toml --from -5.2,1.35,10.8 --to -1.75,1.65,-3 --report --times 1-3 --json -\n"
    "  # How many of at most five shots from 3 s on make B visible?\n"
    "  brume query scenes/demo.toml --from -5.2,1.35,10.8 --to -1.75,1.65,-3 --report --times 2-4 --shots 5 "
    "--shots-at 3\n"
    "  # Colours and distances along the rays of an eye in a tank\n"
    "  brume query reef.spheres --sense \"0,0.1,1.2 0,0,0 70\" --size 16x9 --json -";

}  // namespace

Command add_query(CommandLine& program) {
  Command command = declare(
      program, "query", "Tests whether one point is visible from another through the smoke.", kQueryExamples);
  auto options = std::make_shared<QueryOptions>();
  const Arguments arguments = command.arguments;
  // A sample at one time.
  arguments.add_option("TIMELINE", options->timeline, "Timeline (.toml), scene, or with --sense tank")
      .required()
      .type_name("");
  arguments.add_option("--from", options->from, "Position of the observer [m]").type_name("X,Y,Z");
  arguments.add_option("--to", options->to, "Position of the target [m]").type_name("X,Y,Z");
  arguments.add_option("--time", options->time, "Time of the sample [s]").range(0.0, 3600.0).type_name("S");
  arguments
      .add_option("--threshold", options->threshold,
                  "Optical depth above which smoke hides the target; default 3 (5 % transmittance)")
      .range(0.0, 1e6)
      .type_name("T");
  arguments.add_flag("--drawn", options->drawn, "Through smoke as pictures show it, eroded by noise; slower");
  // A report over time, and shots that would open a line.
  arguments.add_flag("--report", options->report, "List the intervals in which the target is hidden");
  arguments
      .add_option("--times", options->times, "Begin and end of the report [s]; default: the whole timeline")
      .type_name("A-B");
  arguments
      .add_option("--shots", options->shots,
                  "Fire up to N shots at the target and report how many make it visible")
      .range(0u, 100u)
      .type_name("N");
  arguments.add_option("--shots-at", options->shots_at, "Time of the first of these shots [s]; default: A")
      .range(0.0, 3600.0)
      .type_name("S");
  arguments.add_option("--shots-every", options->shots_every, "Interval between these shots [s]; default 0.1")
      .range(0.02, 60.0)
      .type_name("S");
  arguments
      .add_option("--spread", options->spread,
                  "Maximum deviation of these shots from the line [degrees]; default 0")
      .range(0.0, 45.0)
      .type_name("DEG");
  // What the exit code says, and where the smoke comes from.
  arguments
      .add_option("--expect", options->expect,
                  "Exit code 7 unless the target is visible or hidden: at the time, or in the whole report")
      .one_of({"visible", "hidden"})
      .type_name("visible|hidden");
  declare_size_options(arguments, options->scene);
  declare_sense(arguments, options->sense);
  declare_json(arguments, options->json);
  command.run = [arguments, options, common = command.common] {
    query(arguments, *options, common->outputs);
  };
  return command;
}

}  // namespace brume::cli
