// brume-mpi: a picture of a volume that no single device holds. Each process has the bricks of one part
// (volume::Parts) on its device; depths of light are summed, partial rays composited
// (render/volume_part.hpp).
#include <malloc.h>
#include <mpi.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/command_line/arguments.hpp"
#include "apps/command_line/console.hpp"
#include "apps/command_line/json.hpp"
#include "apps/command_line/outputs.hpp"
#include "apps/command_line/parse.hpp"
#include "core/error.hpp"
#include "core/log.hpp"
#include "film/playback.hpp"
#include "film/volume_part.hpp"
#include "gpu/context.hpp"
#include "grids/files/grid_files.hpp"
#include "image/png.hpp"
#include "render/volume_room.hpp"
#include "scenario/frame.hpp"
#include "scenario/scenario.hpp"
#include "scenario/simulation.hpp"
#include "scene/files/load.hpp"
#include "volume/parts.hpp"
#include "volumes/volumes.hpp"

namespace brume::mpi {
namespace {

struct Options {
  std::string input, output, size = "1280x720", camera, device, json;
  bool quiet = false;
};

/// This process among all.
struct Process {
  int rank = 0, count = 1;
  Process() {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &count);
  }
  bool is_first() const { return rank == 0; }
};

/// What a process reports, as numbers that MPI gathers.
struct Facts {
  double load_seconds = 0, light_seconds = 0, march_seconds = 0;
  /// Bricks on the device; memory of the process, once the whole is gone, and at most.
  double volume_bytes = 0, resident_bytes = 0, peak_bytes = 0;
};

class Clock {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// As --device; otherwise the processes of a machine take its GPUs in turn.
std::string device_of(const Options& options) {
  if (!options.device.empty()) return options.device;
  MPI_Comm machine = MPI_COMM_NULL;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  int here = 0;
  MPI_Comm_rank(machine, &here);
  MPI_Comm_free(&machine);
  std::vector<std::size_t> gpus;
  const std::vector<gpu::DeviceInfo> devices = gpu::list_system_devices();
  for (std::size_t i = 0; i < devices.size(); ++i)
    if (devices[i].kind != gpu::DeviceKind::cpu && devices[i].unsupported.empty()) gpus.push_back(i);
  return gpus.empty() ? "" : std::to_string(gpus[static_cast<std::size_t>(here) % gpus.size()]);
}

/// What all processes show, and the part that this one has.
struct Subject {
  scene::Scene scene;
  planning::FrameInput frame;
  volume::Parts parts;
  std::unique_ptr<volume::SparseVolume> part;
  std::vector<std::uint32_t> order;  ///< Parts, the nearest first.
};

scenario::FirstViewOptions view_of(const Options& options) {
  scenario::FirstViewOptions view;
  view.has_ground = false;  // there is no level
  if (!options.camera.empty()) view.camera = cli::parse_camera("--camera", options.camera);
  const glm::vec2 size_px(cli::parse_size("--size", options.size));
  view.aspect = size_px.x / size_px.y;
  return view;
}

scenario::Scenario load_scenario(const Options& options, cli::Outputs& outputs) {
  if (!grids::is_grid_file(options.input))
    throw Error(ErrorCode::usage, options.input + ": expected a volume: .vdb, .nvdb, .brv or .json");
  outputs.reads(grids::files_of(options.input).value_or_throw());
  return scenario::load_scenario(options.input, {}, view_of(options)).value_or_throw();
}

Subject load(const Options& options, const Process& process, cli::Outputs& outputs) {
  scenario::Scenario scenario = load_scenario(options, outputs);
  const scenario::FirstViewOptions view = view_of(options);
  const auto simulation = scenario::Simulation::create(scenario).value_or_throw();
  std::vector<shared::Hole> holes;
  const double end = double{scenario.timeline.duration};
  simulation->advance_to(end);
  scenario::FrameOptions frame_options;
  if (view.camera) frame_options.camera = [camera = *view.camera](double) { return camera; };
  planning::FrameInput frame = scenario::frame_input(scenario, *simulation, end, holes, frame_options);
  if (frame.volumes.size() != 1)
    throw Error(ErrorCode::bad_input, options.input + ": has no density to render");
  // What refers to the scenario, which goes: there is neither smoke nor a level.
  const shared::SmokeLook look = frame.smoke.look;
  frame.smoke = {};
  frame.smoke.look = look;
  frame.level = {};

  // The part replaces the whole, which then goes.
  planning::VolumeInput& shown = frame.volumes.front();
  auto parts = volume::Parts::divide(*shown.volume, static_cast<std::uint32_t>(process.count));
  if (!parts) throw Error(parts.failure().code, options.input + ": " + parts.failure().message);
  auto part = std::make_unique<volume::SparseVolume>(
      part_of_volume(*shown.volume, *parts, static_cast<std::uint32_t>(process.rank)));
  shown.volume = part.get();
  const glm::vec3 eye(glm::inverse(glm::dmat4(shown.world_from_voxel)) *
                      glm::dvec4(glm::dvec3(frame.view.camera.position_world), 1));
  std::vector<std::uint32_t> order = parts->order_from(eye);
  return {std::move(scenario.scene), std::move(frame), std::move(*parts), std::move(part), std::move(order)};
}

/// Memory of this process.
double resident_bytes() {
  ::malloc_trim(0);  // What is freed counts no more.
  std::uint64_t pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return static_cast<double>(resident) * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

void sum_depths(std::vector<float>& depths) {
  MPI_Allreduce(MPI_IN_PLACE, depths.data(), static_cast<int>(depths.size()), MPI_FLOAT, MPI_SUM,
                MPI_COMM_WORLD);
  for (float& depth : depths) depth = std::min(depth, film::kMostDepth);
}

/// The pixels of the whole in the first process; nothing in the others.
film::Pixels composite(const Process& process, const film::Pixels& own,
                       const std::vector<std::uint32_t>& order) {
  const int floats = static_cast<int>(4 * own.size());
  film::Pixels all(process.is_first() ? own.size() * order.size() : 0);
  MPI_Gather(own.data(), floats, MPI_FLOAT, all.data(), floats, MPI_FLOAT, 0, MPI_COMM_WORLD);
  if (!process.is_first()) return {};
  const auto part = [&](std::uint32_t number) {
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(number * own.size());
    return film::Pixels(begin, begin + static_cast<std::ptrdiff_t>(own.size()));
  };
  film::Pixels front = part(order.front());
  for (std::size_t i = 1; i < order.size(); ++i) film::composite_behind(front, part(order[i]));
  return front;
}

/// The facts of all processes, in the first one.
std::vector<Facts> gather(const Process& process, Facts own) {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  own.peak_bytes = 1024.0 * static_cast<double>(usage.ru_maxrss);
  constexpr int kNumbers = sizeof(Facts) / sizeof(double);
  std::vector<Facts> all(static_cast<std::size_t>(process.count));
  MPI_Gather(&own, kNumbers, MPI_DOUBLE, all.data(), kNumbers, MPI_DOUBLE, 0, MPI_COMM_WORLD);
  return all;
}

void report(const Options& options, const std::vector<Facts>& all, const std::string& device) {
  cli::Json list = cli::Json::list({});
  std::string text;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Facts& facts = all[i];
    list.push_back({{"load_seconds", facts.load_seconds},
                    {"light_seconds", facts.light_seconds},
                    {"march_seconds", facts.march_seconds},
                    {"volume_bytes", static_cast<std::uint64_t>(facts.volume_bytes)},
                    {"resident_bytes", static_cast<std::uint64_t>(facts.resident_bytes)},
                    {"peak_bytes", static_cast<std::uint64_t>(facts.peak_bytes)}});
    char line[200];
    std::snprintf(
        line, sizeof line,
        "process %zu: volume %.1f MiB, memory %.0f MiB, at most %.0f MiB, load %.2f s, light %.2f s, march "
        "%.2f s\n",
        i, facts.volume_bytes / (1 << 20), facts.resident_bytes / (1 << 20), facts.peak_bytes / (1 << 20),
        facts.load_seconds, facts.light_seconds, facts.march_seconds);
    text += line;
  }
  if (!options.json.empty())
    cli::write_json(options.json, {{"output", options.output}, {"device", device}, {"processes", list}});
  if (options.json != "-" && !options.quiet) cli::print(text);
}

/// What is shown, by what, ready for the first step that all processes take together.
struct Prepared {
  Subject subject;
  gpu::Context context;
  gpu::CommandRunner runner;
  film::VolumePartRenderer renderer;

  Prepared(const Options& options, const std::string& device, Subject&& shown)
      : subject(std::move(shown)),
        context(gpu::ContextOptions{device, false}),
        runner(context),
        renderer(context, runner, subject.scene, cli::parse_size("--size", options.size)) {}
};

void declare_files(const Options& options, const Process& process, cli::Outputs& outputs) {
  if (scene::lower_extension(options.output) != ".png")
    throw Error(ErrorCode::usage, "-o " + options.output + ": expected a .png file");
  if (!process.is_first()) return;
  outputs.writes("-o", options.output, cli::FileKind::png);
  outputs.writes("--json", options.json, cli::FileKind::json);
}

std::unique_ptr<Prepared> prepare(const Options& options, const Process& process, const std::string& device,
                                  cli::Outputs& outputs) {
  declare_files(options, process, outputs);
  return std::make_unique<Prepared>(options, device, load(options, process, outputs));
}

void declare(const cli::Arguments& arguments, Options& options) {
  arguments.add_option("INPUT", options.input, "Volume (.vdb, .nvdb, .brv, .json of a raw array)")
      .required()
      .type_name("");
  arguments.add_option("-o,--output", options.output, "Picture (.png)").required().type_name("FILE");
  arguments.add_option("--size", options.size, "Image size [px]; default 1280x720").type_name("WxH");
  arguments
      .add_option("--camera", options.camera,
                  "\"px,py,pz tx,ty,tz fov\": position, target [m] and vertical fov [degrees; default 60]")
      .type_name("CAMERA");
  arguments
      .add_option(
          "--device", options.device,
          "Device by number or part of its name; default: each process of a machine takes another GPU")
      .type_name("N|NAME");
  arguments
      .add_option("--json", options.json,
                  "Write times and memory of each process as JSON; - for standard output")
      .type_name("FILE");
  arguments.add_flag("-q,--quiet", options.quiet, "Suppress warnings and the times");
}

/// Runs a step that each process takes alone. The exit code of the first process that fails, which prints
/// why; 0 where none does.
int together(const Process& process, const std::function<void()>& step) {
  std::optional<Failure> failure;
  try {
    step();
  } catch (const Error& error) {
    failure = error.failure();
  } catch (const std::exception& error) {
    failure = Failure{ErrorCode::internal, error.what()};
  }
  int first = failure ? process.rank : process.count;
  MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  if (first == process.count) return 0;
  int code = failure ? static_cast<int>(failure->code) : 0;
  MPI_Bcast(&code, 1, MPI_INT, first, MPI_COMM_WORLD);
  if (first == process.rank) cli::print_failure(failure->message);
  return code;
}

/// Optical depths of the part of this process. A volume that cannot be divided is a fault of the file: no
/// option would change it.
std::vector<float> find_depths(const Options& options, Prepared& prepared) {
  try {
    return prepared.renderer.find_depths(prepared.subject.frame);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::usage) throw;
    throw Error(ErrorCode::bad_input,
                options.input + ": " + error.failure().message + "; or render it by one process");
  }
}

/// The exit code. What processes do together lies between the steps that each takes alone: where one fails,
/// none waits for it.
int render_parts(const Options& options, const Process& process) {
  Clock clock;
  cli::Outputs outputs;
  std::unique_ptr<Prepared> prepared;
  const std::string device = device_of(options);
  int code = together(process, [&] { prepared = prepare(options, process, device, outputs); });
  if (code != 0) return code;
  Facts facts;
  facts.load_seconds = clock.lap();

  // The light in the whole.
  std::vector<float> depths;
  code = together(process, [&] { depths = find_depths(options, *prepared); });
  if (code != 0) return code;
  sum_depths(depths);
  facts.light_seconds = clock.lap();

  // The rays.
  film::Pixels own;
  code = together(process, [&] { own = prepared->renderer.march(depths); });
  if (code != 0) return code;
  facts.march_seconds = clock.lap();
  facts.resident_bytes = resident_bytes();
  facts.volume_bytes = static_cast<double>(prepared->renderer.volume_bytes());
  const film::Pixels all = composite(process, own, prepared->subject.order);
  code = together(process, [&] {
    if (process.is_first()) image::save_png(options.output, prepared->renderer.picture(all)).value_or_throw();
  });
  if (code != 0) return code;
  const std::vector<Facts> of_all = gather(process, facts);
  return together(process, [&] {
    if (process.is_first()) report(options, of_all, prepared->context.info().name);
  });
}

/// As brume render does. The light is part of the march.
void render_whole(const Options& options, const Process& process) {
  Clock clock;
  cli::Outputs outputs;
  declare_files(options, process, outputs);
  scenario::Scenario scenario = load_scenario(options, outputs);
  const glm::uvec2 size_px = cli::parse_size("--size", options.size);
  gpu::Context context({device_of(options), false});
  if (scenario.volumes) scenario.volumes->limit(render::volume_room(context)).value_or_throw();
  film::Playback playback(context, scenario, size_px);
  if (!options.camera.empty()) playback.set_camera(cli::parse_camera("--camera", options.camera));
  if (scenario.measure_exposure) playback.measure_exposure();
  Facts facts;
  facts.load_seconds = clock.lap();
  const image::Image8 picture = playback.draw(double{scenario.timeline.duration}, 0);
  facts.march_seconds = clock.lap();
  facts.resident_bytes = resident_bytes();
  if (scenario.volumes)
    facts.volume_bytes =
        static_cast<double>(std::uint64_t{scenario.volumes->typical_frame(0).density.volume->slot_count()} *
                            shared::kTexelsPerBrick * sizeof(std::uint16_t));
  image::save_png(options.output, picture).value_or_throw();
  report(options, gather(process, facts), context.info().name);
}

int run(int argc, char** argv) {
  const Process process;
  const cli::Console console;
  Options options;
  cli::CommandLine program(
      "Renders a volume by several processes, each with a part of it on its device.\n\nExamples:\n"
      "  mpirun -n 4 brume-mpi render cloud.brv -o cloud.png --size 640x480",
      "brume-mpi", BRUME_VERSION);
  declare(program.add_command("render", "Renders a volume to an image."), options);

  // The first process prints the help, and what is wrong.
  int go_on = 1;
  int code = together(process, [&] { go_on = process.is_first() ? program.parse(argc, argv) : 1; });
  MPI_Bcast(&go_on, 1, MPI_INT, 0, MPI_COMM_WORLD);
  if (code != 0 || go_on == 0) return code;
  if (!process.is_first()) program.parse(argc, argv);
  cli::set_json("brume-mpi render", options.json);
  if (process.is_first() && !options.quiet)
    set_log_callback([](LogLevel level, const std::string& line) {
      if (level == LogLevel::warning) cli::print_failure("warning: " + line);
    });

  if (process.count > 1) return render_parts(options, process);
  return together(process, [&] { render_whole(options, process); });
}

}  // namespace
}  // namespace brume::mpi

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  const int code = brume::mpi::run(argc, argv);
  MPI_Finalize();
  return code;
}
