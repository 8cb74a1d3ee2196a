#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <vector>

#include "apps/cli/command.hpp"
#include "apps/cli/scene_options.hpp"
#include "apps/cli/stopwatch.hpp"
#include "apps/command_line/console.hpp"
#include "apps/command_line/json.hpp"
#include "apps/command_line/parse.hpp"
#include "apps/command_line/targets.hpp"
#include "core/error.hpp"
#include "core/log.hpp"
#include "core/progress.hpp"
#include "core/utf8.hpp"
#include "grids/files/grid_files.hpp"
#include "planning/smoke_look.hpp"
#include "scenario/events.hpp"
#include "scenario/simulation.hpp"
#include "scenario/smoke_grid.hpp"
#include "scenario/wall_smoke.hpp"
#include "scene/files/load.hpp"
#include "scene/text_reader.hpp"
#include "smoke/drawn_smoke.hpp"
#include "smoke/holes.hpp"
#include "wire/packet.hpp"
#include "wire/replay.hpp"

namespace brume::cli {
namespace {

constexpr std::uint32_t kMaxTicks = 1u << 22;  // 18 hours at 64 Hz

struct SimOptions {
  std::string timeline, record, replay, json, volumes, frames, fps = "24", up = "y";
  SceneOptions scene;
  std::optional<std::uint32_t> ticks, rate;
  std::optional<double> detail;  // edge of voxels of drawn smoke [m]
  bool hash = false;
};

FileKind volume_kind(const std::filesystem::path& path) {
  const std::string extension = scene::lower_extension(path);
  return extension == ".vdb" ? FileKind::vdb : extension == ".nvdb" ? FileKind::nvdb : FileKind::brv;
}

// Refuses options that would do nothing, and names that cannot be written. Numbered files without --frames
// are declared when the timeline is known.
void check_volumes(const Arguments& arguments, const SimOptions& options, Outputs& outputs) {
  if (options.volumes.empty()) {
    for (const char* option : {"--frames", "--fps", "--up", "--detail"})
      arguments.refuse(option, "requires --volumes");
    return;
  }
  expect_suffix("--volumes", options.volumes, {".vdb", ".nvdb", ".brv"});
  if (options.detail)
    arguments.refuse("--rate", "cannot be combined with --detail, which draws 64 ticks a second");
  parse_rate("--fps", options.fps);
  if (!is_numbered("--volumes", to_path(options.volumes))) {
    for (const char* option : {"--frames", "--fps"})
      arguments.refuse(option, "requires numbered files, such as --volumes smoke_%04d.vdb");
    outputs.writes("--volumes", plain_name(to_path(options.volumes)), volume_kind(to_path(options.volumes)));
    return;
  }
  outputs.set_resumable(false);
  if (options.frames.empty()) return check_writable(sequence_name(to_path(options.volumes), 0));
  const FrameRange range = parse_frames("--frames", options.frames);
  outputs.writes_frames("--volumes", to_path(options.volumes), volume_kind(to_path(options.volumes)),
                        range.first, range.last);
}

void check_options(const Arguments& arguments, const SimOptions& options, Outputs& outputs) {
  if (options.timeline.empty() && options.replay.empty())
    throw Error(ErrorCode::usage, "expected a timeline, such as scenes/demo.toml, or --replay FILE");
  if (!options.replay.empty()) {
    if (!options.timeline.empty())
      throw Error(ErrorCode::usage, "--replay: needs no timeline; remove " + options.timeline +
                                        " or --replay " + options.replay);
    for (const char* option : {"--ticks", "--rate", "--record", "--volumes", "--voxel", "--scale"})
      arguments.refuse(option, "cannot be combined with --replay, whose recording sets it; remove one");
    expect_suffix("--replay", options.replay, {".brp"});
  }
  for (const std::string& input : {options.timeline, options.replay}) outputs.reads(to_path(input));
  outputs.writes("--record", to_path(options.record), FileKind::brp);
  outputs.writes("--json", to_path(options.json), FileKind::json);
  check_volumes(arguments, options, outputs);
}

// The ticks to simulate, and which of them give a volume file of their smoke.
struct Schedule {
  std::uint32_t rate = 0, ticks = 0;
  FrameRate frame_rate;
  FrameRange frames;

  std::uint32_t tick_of(std::uint32_t frame) const {
    return scenario::tick_at(frame_rate.time_of(frame), rate);
  }
};

// Frames beyond the timeline's end are simulated unless --ticks excludes them.
void extend_to_frames(const SimOptions& options, const scene::Timeline& timeline, Schedule& schedule) {
  const std::string frames = "--frames " + options.frames + ": the last is at ";
  const std::uint32_t last = schedule.tick_of(schedule.frames.last);
  if (last < schedule.ticks) return;
  const std::uint32_t most = options.ticks.value_or(kMaxTicks);
  if (last >= most)
    throw Error(ErrorCode::usage, frames + "tick " + std::to_string(last) + ", after the last one, " +
                                      std::to_string(most - 1));
  const double seconds = schedule.frame_rate.time_of(schedule.frames.last), end{timeline.duration};
  if (seconds > end)
    log_warning(frames + scene::shown(seconds) + " s, after the end of the timeline at " + scene::shown(end) +
                " s");
  schedule.ticks = last + 1;
}

Schedule make_schedule(const SimOptions& options, const scene::Timeline& timeline) {
  Schedule schedule;
  schedule.rate = options.rate.value_or(sim::WorldSettings{}.ticks_per_second);
  schedule.frame_rate = parse_rate("--fps", options.fps);
  schedule.ticks = options.ticks.value_or(
      std::clamp(scenario::tick_at(double{timeline.duration}, schedule.rate), 1u, kMaxTicks));
  if (!options.frames.empty()) {
    schedule.frames = parse_frames("--frames", options.frames);
    extend_to_frames(options, timeline, schedule);
  } else {
    const double frames = schedule.ticks * schedule.frame_rate.per_second() / schedule.rate;
    schedule.frames.last = static_cast<std::uint32_t>(std::ceil(frames));
    while (schedule.frames.last > 0 && schedule.tick_of(schedule.frames.last) >= schedule.ticks)
      --schedule.frames.last;
  }
  return schedule;
}

// Writes the smoke of the frames, or of the last tick, as the ticks pass.
class VolumeFiles {
 public:
  VolumeFiles(const SimOptions& options, const scenario::Scenario& scenario, const Schedule& schedule,
              Outputs& outputs)
      : path_(to_path(options.volumes)),
        numbered_(!path_.empty() && is_numbered("--volumes", path_)),
        schedule_(schedule),
        scenario_(scenario),
        detail_(options.detail),
        frame_(schedule.frames.first),
        outputs_(outputs) {
    grid_options_.up = options.up == "z" ? scenario::UpAxis::z : scenario::UpAxis::y;
    grid_options_.extinction = scenario.timeline.smoke.extinction;
    if (numbered_ && options.frames.empty())
      outputs.writes_frames("--volumes", path_, volume_kind(path_), schedule.frames.first,
                            schedule.frames.last);
  }

  void take(const sim::World& world) {
    if (path_.empty()) return;
    const sim::State& state = world.state();
    if (!numbered_) {
      if (state.tick + 1 == schedule_.ticks) save(plain_name(path_), world);
      return;
    }
    for (; frame_ <= schedule_.frames.last && schedule_.tick_of(frame_) == state.tick; ++frame_) {
      save(sequence_name(path_, frame_), world);
      outputs_.frame_done(frame_);
    }
  }
  std::uint32_t written() const { return written_; }

 private:
  void save(const std::filesystem::path& path, const sim::World& world) {
    stop_if_interrupted();
    grids::save_grid_file(path, {{detail_ ? drawn(world) : up_to_walls(world)}, {}}).value_or_throw();
    ++written_;
  }

  grids::Grid up_to_walls(const sim::World& world) {
    if (!smoke_) smoke_.emplace(scenario_);
    return smoke_->grid(world, grid_options_);
  }

  grids::Grid drawn(const sim::World& world) {
    if (!simulation_) simulation_ = scenario::Simulation::create(scenario_).value_or_throw();
    simulation_->advance_to(static_cast<double>(world.tick()) / world.settings().ticks_per_second);
    const sim::State& state = simulation_->world().state();
    const scene::SmokeOptions& look = scenario_.timeline.smoke;
    const auto holes = smoke::make_holes(state, &scenario_.masks);
    const smoke::DrawnSmoke smoke({.volume = &simulation_->volume(),
                                   .state = &state,
                                   .holes = holes,
                                   .look = planning::smoke_look(look, state.layout.voxel_size),
                                   .swirl_period = double{look.swirl_period},
                                   .time = state.seconds(state.tick)},
                                  smoke::smoke_noise, &scenario_.masks);
    auto grid = scenario::drawn_smoke_grid(smoke, static_cast<float>(*detail_), grid_options_);
    if (!grid) throw Error(grid.failure().code, "--detail: " + grid.failure().message);
    return std::move(*grid);
  }

  std::filesystem::path path_;
  bool numbered_;
  const Schedule& schedule_;
  const scenario::Scenario& scenario_;
  std::optional<double> detail_;
  std::optional<scenario::FollowedSmoke> smoke_;
  std::unique_ptr<scenario::Simulation> simulation_;  // makes drawn smoke, with the surfaces of doors
  std::uint32_t frame_, written_ = 0;
  scenario::SmokeGridOptions grid_options_;
  Outputs& outputs_;
};

// The result of a run: the state hash of each tick.
struct Run {
  std::vector<std::uint64_t> hashes;
  Stopwatch watch;

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

// What a run reports besides its hashes; of a replay nothing.
struct Simulated {
  Json smokes;
  std::uint32_t volumes = 0;  // files
};

void report(const SimOptions& options, const Run& run, std::uint32_t rate,
            const std::optional<Simulated>& simulated) {
  const bool compared = !simulated;
  // As JSON.
  if (!options.json.empty()) {
    Json result{{"ticks", run.hashes.size()},
                {"ticks_per_second", rate},
                {"hash", hex(run.hashes.back())},
                {"milliseconds", 1000 * run.watch.seconds()}};
    if (compared) result.set("same", true);
    if (simulated) result.set("smokes", simulated->smokes);
    if (!options.volumes.empty()) result.set("volumes", simulated->volumes);
    if (options.hash) {
      Json hashes = Json::list({});
      for (const std::uint64_t hash : run.hashes) hashes.push_back(hex(hash));
      result.set("hashes", hashes);
    }
    write_json(options.json, result);
  }
  if (options.json == "-") return;
  // As text: every tick, or the last one.
  const std::size_t last = run.hashes.size() - 1;
  for (std::size_t tick = options.hash ? 0 : last; tick <= last; ++tick)
    print(options.hash ? std::to_string(tick) + " " + hex(run.hashes[tick]) + "\n"
                       : std::to_string(run.hashes.size()) + " ticks simulated; state hash of the last " +
                             hex(run.hashes[tick]) + "\n");
  if (compared) print(std::to_string(run.hashes.size()) + " ticks match the recording\n");
}

void simulate(const SimOptions& options, Outputs& outputs) {
  Run run;
  // Load the timeline, and declare all files before any work.
  const scenario::Scenario scenario =
      load_with_options(options.timeline, "", parse_scene_options(options.scene));
  outputs.reads(scenario::files_of(scenario));
  stop_if_interrupted();
  const Schedule schedule = make_schedule(options, scenario.timeline);
  VolumeFiles volumes(options, scenario, schedule, outputs);
  const std::vector<sim::Event> events = scenario::events_of(scenario, schedule.rate).value_or_throw();

  // Simulate. A recording holds the level, the events and a checksum of each tick.
  const sim::WorldSettings settings{schedule.rate, scenario.masks.key(), scenario.voxels.level_hash()};
  wire::Replay replay = wire::make_replay(scenario.voxels.solids(), settings, events);
  sim::World world(scenario.voxels.solids(), settings);
  world.append(events).value_or_throw();
  const Json smokes = report_timeline(scenario, scenario::report_smokes(scenario, world));
  Progress job("ticks", schedule.ticks);
  for (std::uint32_t tick = 0; tick < schedule.ticks; ++tick) {
    world.advance_to(tick);
    run.take(world.state());
    if (!options.record.empty()) replay.checksums.push_back(wire::checksum_of(world.state()));
    volumes.take(world);
    job.advance();
  }
  if (!options.record.empty()) wire::save_replay(to_path(options.record), replay).value_or_throw();
  report(options, run, schedule.rate, Simulated{smokes, volumes.written()});
}

void verify_replay(const SimOptions& options) {
  Run run;
  const wire::Replay replay = wire::load_replay(to_path(options.replay)).value_or_throw();
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
              "  brume sim --replay demo.brp\n"
              "  brume sim scenes/demo.toml --volumes smoke_%04d.vdb --frames 48-50 --up z\n"
              "  brume sim scenes/demo.toml --volumes end.vdb --detail 0.05");
  auto options = std::make_shared<SimOptions>();
  const Arguments arguments = command.arguments;
  // What is simulated.
  arguments.add_option("TIMELINE", options->timeline, "Timeline (.toml) or scene").type_name("");
  arguments.add_option("--ticks", options->ticks, "Number of ticks to simulate; default: the duration")
      .range(1u, kMaxTicks)
      .type_name("N");
  arguments.add_option("--rate", options->rate, "Ticks per second; default 64")
      .range(1u, 1000u)
      .type_name("N");
  declare_size_options(arguments, options->scene);
  // What is reported and recorded.
  arguments.add_flag("--hash", options->hash, "Print the number and state hash of every tick");
  arguments.add_option("--record", options->record, "Record the level, the events and a checksum per tick")
      .type_name("FILE");
  arguments
      .add_option("--replay", options->replay,
                  "Simulate a recording and compare; exit code 7 if a tick differs")
      .type_name("FILE");
  // What is written as volumes.
  arguments
      .add_option("--volumes", options->volumes,
                  "Write the smoke as .vdb, .nvdb or .brv: of each frame with %04d, else of the last tick")
      .type_name("FILE");
  arguments.add_option("--frames", options->frames, "First and last frame of --volumes; default: all")
      .take_last()
      .type_name("A-B");
  arguments.add_option("--fps", options->fps, "Frames of --volumes per second; default 24")
      .take_last()
      .type_name("F");
  arguments
      .add_option("--up", options->up, "Axis of --volumes that points up: y or, for Blender, z; default y")
      .one_of({"y", "z"})
      .type_name("y|z");
  arguments
      .add_option(
          "--detail", options->detail,
          "Write the smoke of --volumes as pictures show it, eroded and with holes, in voxels of M metres")
      .range(0.005, 10.0)
      .type_name("M");
  declare_json(arguments, options->json);
  command.run = [arguments, options, common = command.common] {
    check_options(arguments, *options, common->outputs);
    options->replay.empty() ? simulate(*options, common->outputs) : verify_replay(*options);
  };
  return command;
}

}  // namespace brume::cli
