#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>
#include <vector>

#include "apps/cli/command.hpp"
#include "apps/cli/console.hpp"
#include "apps/cli/json.hpp"
#include "apps/cli/scene_options.hpp"
#include "core/error.hpp"
#include "core/progress.hpp"
#include "scenario/events.hpp"
#include "wire/packet.hpp"
#include "wire/replay.hpp"

namespace brume::cli {
namespace {

constexpr std::uint32_t kMaxTicks = 1u << 22;  // 18 hours at 64 Hz

struct SimOptions {
  std::string timeline, record, replay, json;
  SceneOptions scene;
  std::optional<std::uint32_t> ticks, rate;
  bool hash = false;
};

void check_options(const Arguments& arguments, const SimOptions& options, Outputs& outputs) {
  if (options.timeline.empty() && options.replay.empty())
    throw Error(ErrorCode::usage, "expected a timeline, such as scenes/demo.toml, or --replay FILE");
  if (!options.replay.empty()) {
    if (!options.timeline.empty())
      throw Error(ErrorCode::usage, "--replay: needs no timeline; remove " + options.timeline +
                                        " or --replay " + options.replay);
    for (const char* option : {"--ticks", "--rate", "--record", "--voxel", "--scale"})
      arguments.refuse(option, "cannot be combined with --replay, whose recording sets it; remove one");
    expect_suffix("--replay", options.replay, {".brp"});
  }
  for (const std::string& input : {options.timeline, options.replay})
    outputs.reads(std::filesystem::path(input));
  outputs.writes("--record", options.record, FileKind::brp);
  outputs.writes("--json", options.json, FileKind::json);
}

// The result of a run: the state hash of each tick.
struct Run {
  std::vector<std::uint64_t> hashes;
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();

  void take(const sim::State& state) {
    stop_if_interrupted();
    hashes.push_back(state.hash());
  }
};

std::string hex(std::uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

void report(const SimOptions& options, const Run& run, std::uint32_t rate,
            const std::optional<Json>& smokes) {
  const bool compared = !smokes;
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - run.start;
  if (!options.json.empty()) {
    Json result{{"ticks", run.hashes.size()},
                {"ticks_per_second", rate},
                {"hash", hex(run.hashes.back())},
                {"milliseconds", took.count()}};
    if (compared) result.set("same", true);
    if (smokes) result.set("smokes", *smokes);
    if (options.hash) {
      Json hashes = Json::list({});
      for (const std::uint64_t hash : run.hashes) hashes.push_back(hex(hash));
      result.set("hashes", hashes);
    }
    write_json(options.json, result);
  }
  if (options.json == "-") return;
  const std::size_t last = run.hashes.size() - 1;
  for (std::size_t tick = options.hash ? 0 : last; tick <= last; ++tick)
    print(options.hash ? std::to_string(tick) + " " + hex(run.hashes[tick]) + "\n"
                       : std::to_string(run.hashes.size()) + " ticks simulated; state hash of the last " +
                             hex(run.hashes[tick]) + "\n");
  if (compared) print(std::to_string(run.hashes.size()) + " ticks match the recording\n");
}

void simulate(const SimOptions& options, Outputs& outputs) {
  const std::uint32_t rate = options.rate.value_or(sim::WorldSettings{}.ticks_per_second);
  Run run;
  const scenario::Scenario scenario =
      load_with_options(options.timeline, "", parse_scene_options(options.scene));
  outputs.reads(scenario::files_of(scenario));
  stop_if_interrupted();
  const std::vector<sim::Event> events = scenario::events_of(scenario, rate).value_or_throw();
  const std::uint32_t ticks = options.ticks.value_or(
      std::clamp(scenario::tick_at(double{scenario.timeline.duration}, rate), 1u, kMaxTicks));

  const sim::WorldSettings settings{rate, scenario.masks.key()};
  wire::Replay replay = wire::replay_of(scenario.voxels.grid, settings, events);
  sim::World world(scenario.voxels.grid, settings);
  world.append(events).value_or_throw();
  const Json smokes = report_timeline(scenario, scenario::report_smokes(scenario, world));
  Progress job("ticks", ticks);
  for (std::uint32_t tick = 0; tick < ticks; ++tick) {
    world.advance_to(tick);
    run.take(world.state());
    if (!options.record.empty()) replay.checksums.push_back(wire::checksum_of(world.state()));
    job.advance();
  }
  if (!options.record.empty()) wire::save_replay(options.record, replay).value_or_throw();
  report(options, run, rate, smokes);
}

void verify_replay(const SimOptions& options) {
  Run run;
  const wire::Replay replay = wire::load_replay(options.replay).value_or_throw();
  if (replay.checksums.empty())
    throw Error(ErrorCode::bad_input, options.replay + ": the recording has no ticks; record it again");
  Progress job("ticks", replay.checksums.size());
  const auto take = [&](const sim::State& state) {
    run.take(state);
    job.advance();
  };
  const auto divergence = wire::play(replay, take).value_or_throw();
  if (divergence)
    throw Error(ErrorCode::comparison_failed,
                options.replay + ": tick " + std::to_string(divergence->tick) + " differs: recorded " +
                    hex(divergence->recorded).substr(8) + ", simulated " + hex(divergence->got).substr(8));
  report(options, run, replay.settings.ticks_per_second, std::nullopt);
}

}  // namespace

Command add_sim(CommandLine& program) {
  Command command =
      declare(program, "sim", "Simulates a timeline without rendering; records it, or verifies a recording.",
              "  brume sim scenes/demo.toml --ticks 64 --hash\n"
              "  brume sim scenes/demo.toml --record demo.brp\n"
              "  brume sim --replay demo.brp");
  auto options = std::make_shared<SimOptions>();
  const Arguments arguments = command.arguments;
  arguments.add_option("TIMELINE", options->timeline, "Timeline (.toml) or scene").type_name("");
  arguments.add_option("--ticks", options->ticks, "Number of ticks to simulate; default: the duration")
      .range(1u, kMaxTicks)
      .type_name("N");
  arguments.add_option("--rate", options->rate, "Ticks per second; default 64")
      .range(1u, 1000u)
      .type_name("N");
  declare_size_options(arguments, options->scene);
  arguments.add_flag("--hash", options->hash, "Print the number and state hash of every tick");
  arguments.add_option("--record", options->record, "Record the level, the events and a checksum per tick")
      .type_name("FILE");
  arguments
      .add_option("--replay", options->replay,
                  "Simulate a recording and compare; exit code 7 if a tick differs")
      .type_name("FILE");
  arguments.add_option("--json", options->json, "Write the result as JSON; - for standard output")
      .type_name("FILE");
  command.run = [arguments, options, common = command.common] {
    check_options(arguments, *options, common->outputs);
    options->replay.empty() ? simulate(*options, common->outputs) : verify_replay(*options);
  };
  return command;
}

}  // namespace brume::cli
