#include "apps/cli/command.hpp"
#include "apps/cli/scene_options.hpp"
#include "apps/cli/tank_options.hpp"
#include "apps/command_line/console.hpp"
#include "apps/command_line/json.hpp"
#include "apps/command_line/parse.hpp"
#include "apps/viewer/quality.hpp"
#include "apps/viewer/screenshot.hpp"
#include "apps/viewer/viewer.hpp"
#include "core/data_files.hpp"
#include "core/error.hpp"
#include "image/decode.hpp"

namespace brume::cli {
namespace {

struct ViewOptions {
  std::string input, play, size = "1280x720", device, quality = "auto", view = "none", word = "BRUME",
                           picture, folder = ".", screenshot, record, frame_log, json;
  std::string shaders;
  SceneOptions scene;
  std::uint32_t volume_memory = 0;  // [MiB]
  double frames_per_second = 60;
  std::optional<double> time, exit_after, lose_device, lose_surface;
  bool panels = false, bare = false, no_vertical_sync = false, validation = false, log_widgets = false;
};

viewer::ViewerOptions viewer_options(const ViewOptions& options) {
  viewer::ViewerOptions viewer;
  // The window and the device.
  viewer.size_px = parse_size("--size", options.size);
  viewer.device = options.device;
  viewer.validation = options.validation;
  viewer.vertical_sync = !options.no_vertical_sync;
  viewer.volume_bytes = std::uint64_t{options.volume_memory} << 20;
  viewer.frames_per_second = options.frames_per_second;
  const auto levels = viewer::quality_levels();
  for (std::size_t i = 0; i < levels.size(); ++i)
    if (options.quality == levels[i].name) viewer.level = i;
  // What it shows at first.
  viewer.view = passes::find_debug_view(options.view).value_or(passes::DebugView::none);
  viewer.panels = options.panels;
  viewer.overlay = !options.bare;
  viewer.weapons.text.text = options.word;
  viewer.weapons.picture = options.picture;
  viewer.folder = options.folder;
  viewer.shaders =
      options.shaders.empty() ? find_data_file("shaders").value_or("").string() : options.shaders;
  // What it does by itself, for tests and films.
  viewer.begin_at = options.time;
  viewer.exit_after = options.exit_after;
  viewer.screenshot = options.screenshot;
  viewer.record = options.record;
  viewer.frame_log = options.frame_log;
  viewer.log_widgets = options.log_widgets;
  viewer.check_signals = stop_if_interrupted;
  viewer.say = print_on_terminal;
  viewer.lose_device = options.lose_device;
  viewer.lose_surface = options.lose_surface;
  return viewer;
}

std::vector<std::string> quality_names() {
  std::vector<std::string> names{"auto"};
  for (const viewer::Quality& quality : viewer::quality_levels()) names.emplace_back(quality.name);
  return names;
}

std::vector<std::string> view_names() {
  return {passes::kDebugViewNames.begin(), passes::kDebugViewNames.end()};
}

Json json_of(const viewer::LevelReport& level) {
  char hash[17];
  std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(level.state_hash));
  Json passes = Json::object();
  for (const auto& [name, milliseconds] : level.passes_ms) passes.set(name, milliseconds);
  return {{"frames_per_second", level.frames_per_second},
          {"work_ms", level.work_ms},
          {"latency_ms", level.latency_ms},
          {"simulation_ms", level.tick_ms},
          {"passes_ms", passes},
          {"quality", level.quality},
          {"tick", level.tick},
          {"state_hash", hash}};
}

Json json_of(const viewer::TankReport& tank) {
  return {{"spheres", tank.spheres},
          {"samples_per_pixel", tank.samples},
          {"size", Json::list({tank.picture_px.x, tank.picture_px.y})},
          {"packings", tank.packings}};
}

void write_report(const std::string& target, const viewer::ViewerReport& report) {
  if (target.empty()) return;
  Json json{{"device", report.device}, {"frames", report.frames}, {"seconds", report.seconds}};
  json.update(std::visit([](const auto& document) { return json_of(document); }, report.document));
  json.update(Json{{"process_bytes", report.process_bytes},
                   {"device_bytes", report.device_bytes},
                   {"shader_reloads", report.shader_reloads},
                   {"devices_lost", report.devices_lost},
                   {"validation_messages", report.validation_messages}});
  write_json(target, json);
}

/// What the window reads and writes only later must not fail then.
void check_inputs(const ViewOptions& options) {
  const auto is_folder = [](const char* option, const std::string& folder) {
    if (!std::filesystem::is_directory(folder))
      throw Error(ErrorCode::bad_input, std::string(option) + " " + folder + ": no such folder");
  };
  is_folder("--folder", options.folder);
  if (!options.shaders.empty()) is_folder("--shaders", options.shaders);
  if (!options.picture.empty()) {
    const auto image = image::load_image(options.picture);
    if (!image) throw Error(image.failure().code, "--shot " + image.failure().message);
  }
  if (options.word.empty() || options.word.size() > scene::kMaxTextBytes ||
      options.word.find_first_not_of(' ') == std::string::npos)
    throw Error(ErrorCode::usage, "--word: expected 1 to " + std::to_string(scene::kMaxTextBytes) +
                                      " bytes with at least one letter, such as BRUME");
}

void view(const Arguments& arguments, const ViewOptions& options, Outputs& outputs) {
  if (!options.input.empty() && !options.play.empty())
    throw Error(ErrorCode::usage, "--play: already names the timeline; remove INPUT");
  if (!options.screenshot.empty() && !options.exit_after)
    throw Error(ErrorCode::usage, "--screenshot is taken at --exit-after; add that option");
  check_inputs(options);
  const bool plays = !options.play.empty();
  const std::filesystem::path input = plays                   ? options.play
                                      : options.input.empty() ? data_file("scenes/demo.toml").string()
                                                              : options.input;
  const bool is_tank = scenario::is_tank_input(input);
  if (is_tank) refuse_options_of_levels(arguments);
  viewer::ViewerOptions viewer = viewer_options(options);
  scenario::FirstViewOptions first_view = parse_scene_options(options.scene);
  first_view.aspect = static_cast<float>(viewer.size_px.x) / static_cast<float>(viewer.size_px.y);
  viewer.level_name = input.filename().string();
  declare_input(outputs, input);
  outputs.reads(options.picture);
  outputs.writes("--screenshot", options.screenshot, FileKind::png);
  if (!options.screenshot.empty())
    outputs.writes("--screenshot", viewer::snapshot_timeline(options.screenshot), FileKind::timeline);
  outputs.writes("--record", options.record, FileKind::timeline);
  outputs.writes("--frame-log", options.frame_log, FileKind::frame_log);
  outputs.writes("--json", options.json, FileKind::json);
  outputs.up_to_date(options.frame_log);  // It is written in place, line by line.
  const auto load = [&] {
    scenario::Scenario scenario = load_with_options(input, {}, first_view);
    outputs.reads(scenario::files_of(scenario));
    return scenario;
  };
  const auto make = [&](const std::function<bool()>& stopped) {
    return load_tank(input, first_view, stopped);
  };
  const viewer::ViewerReport report =
      is_tank ? viewer::run_viewer(make, plays, viewer) : viewer::run_viewer(load, plays, viewer);
  write_report(options.json, report);
  if (report.validation_messages.empty()) return;
  throw Error(ErrorCode::internal, "the validation layers reported " +
                                       std::to_string(report.validation_messages.size()) +
                                       " errors; the first: " + report.validation_messages.front());
}

/// What the window starts with, and what it leaves behind.
void declare_outputs(const Arguments& arguments, ViewOptions& options) {
  // Files that the window writes.
  arguments
      .add_option("--folder", options.folder,
                  "Folder for screenshots and recordings; default: current folder")
      .type_name("FOLDER");
  arguments.add_option("--record", options.record, "On exit, write the session as a timeline")
      .type_name("FILE");
  arguments.add_option("--exit-after", options.exit_after, "Close the window at this simulation time [s]")
      .take_last()
      .range(0.01, 3600.0)
      .type_name("S");
  arguments.add_option("--screenshot", options.screenshot, "Save an image at the time of --exit-after")
      .type_name("FILE");
  // How it starts.
  arguments.add_flag("--panels", options.panels, "Start with the panels open");
  arguments.add_flag("--bare", options.bare, "Start without any overlay");
  // For developers.
  arguments.add_flag("--no-vsync", options.no_vertical_sync, "Do not wait for vertical sync");
  arguments.add_option("--shaders", options.shaders, "Folder of shader sources to watch for changes")
      .type_name("FOLDER");
  arguments.add_flag("--validation", options.validation, "Enable the Vulkan validation layers");
  declare_device(arguments, options.device);
  arguments
      .add_option("--frame-log", options.frame_log,
                  "Write one CSV line per frame while the window is open: times, memory")
      .type_name("FILE");
  declare_json(arguments, options.json, "the measurements");
}

void declare_tests(const Arguments& arguments, ViewOptions& options) {
  // For tests of the window.
  arguments.add_flag("--log-widgets", options.log_widgets, "").hidden();
  arguments.add_option("--lose-device", options.lose_device, "").hidden().range(0.0, 3600.0);
  arguments.add_option("--lose-surface", options.lose_surface, "").hidden().range(0.0, 3600.0);
}

}  // namespace

Command add_view(CommandLine& program) {
  Command command =
      declare(program, "view", "Opens a window to walk through a scene, throw smoke and shoot through it.",
              "  brume view                              # the demo house at night; H shows the keys\n"
              "  brume view room.glb --quality half\n"
              "  brume view --play scenes/demo.toml --time 4.1 --panels\n"
              "  brume view --play scenes/demo.toml      # play the events of the timeline\n"
              "  brume view --play scenes/demo.toml --exit-after 3 --screenshot end.png --size 640x360");
  auto options = std::make_shared<ViewOptions>();
  const Arguments arguments = command.arguments;
  arguments
      .add_option("INPUT", options->input,
                  "Scene, timeline (.toml) whose events are ignored, or tank of spheres")
      .type_name("");
  arguments.add_option("--play", options->play, "Timeline to play").type_name("FILE");
  arguments.add_option("--time", options->time, "Start at this time [s]; paused, without --exit-after")
      .range(0.0, 3600.0)
      .type_name("S");
  arguments.add_option("--size", options->size, "Window size [px]; default 1280x720")
      .take_last()
      .type_name("WxH");
  arguments
      .add_option("--quality", options->quality,
                  "Quality of the smoke; default auto: the best that holds --fps")
      .take_last()
      .one_of(quality_names())
      .type_name("NAME");
  arguments
      .add_option("--fps", options->frames_per_second,
                  "Frame rate that --quality auto holds [1/s]; default 60")
      .range(1.0, 1000.0)
      .type_name("F");
  arguments.add_option("--view", options->view, "Initial debug view; see docs/reference/command-line.md")
      .one_of(view_names())
      .type_name("NAME");
  arguments.add_option("--word", options->word, "Word whose letters are shot; default BRUME")
      .type_name("TEXT");
  arguments.add_option("--shot", options->picture, "Image whose shape is shot").type_name("FILE");
  declare_level_options(arguments, options->scene);
  declare_volume_memory(arguments, options->volume_memory);
  declare_outputs(arguments, *options);
  // It saves its session before it ends.
  command.common->grace_seconds = 5;
  declare_tests(arguments, *options);
  command.run = [arguments, options, common = command.common] { view(arguments, *options, common->outputs); };
  return command;
}

}  // namespace brume::cli
