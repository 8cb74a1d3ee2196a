#include "apps/cli/view_tank.hpp"

#include "apps/command_line/console.hpp"
#include "apps/command_line/json.hpp"
#include "apps/viewer/screenshot.hpp"
#include "apps/viewer/tank_viewer.hpp"
#include "scenario/tank.hpp"

namespace brume::cli {
namespace {

// What is for levels and their smoke.
void refuse_options_of_levels(const Arguments& arguments) {
  for (const char* option : {"--quality", "--fps", "--view", "--word", "--shot", "--record",
                             "--volume-memory", "--smoke-size", "--voxel", "--scale", "--sun", "--bounces"})
    arguments.refuse(option, "is not for a tank of spheres");
}

void write_tank_report(const std::string& target, const viewer::TankViewerReport& report) {
  if (target.empty()) return;
  write_json(target, Json{{"device", report.device},
                          {"frames", report.frames},
                          {"seconds", report.seconds},
                          {"spheres", report.spheres},
                          {"samples_per_pixel", report.samples},
                          {"size", Json::list({report.picture_px.x, report.picture_px.y})},
                          {"packings", report.packings},
                          {"process_bytes", report.process_bytes},
                          {"device_bytes", report.device_bytes},
                          {"shader_reloads", report.shader_reloads},
                          {"devices_lost", report.devices_lost},
                          {"validation_messages", report.validation_messages}});
}

}  // namespace

void view_tank(const Arguments& arguments, const ViewOptions& options, const std::filesystem::path& input,
               Outputs& outputs) {
  refuse_options_of_levels(arguments);
  viewer::ViewerOptions viewer = viewer_options(options);
  viewer.level_name = input.filename().string();
  const scenario::FirstViewOptions first_view = parse_scene_options(options.scene);
  outputs.reads(scenario::files_of_tank_input(input));
  outputs.writes("--screenshot", options.screenshot, FileKind::png);
  if (!options.screenshot.empty())
    outputs.writes("--screenshot", viewer::snapshot_timeline(options.screenshot), FileKind::timeline);
  outputs.writes("--frame-log", options.frame_log, FileKind::frame_log);
  outputs.writes("--json", options.json, FileKind::json);
  outputs.up_to_date(options.frame_log);  // It is written in place, line by line.
  const auto make = [&](const std::function<bool()>& stopped) {
    scenario::TankScenario scenario = scenario::load_tank_scenario(input, stopped).value_or_throw();
    if (first_view.exposure) scenario.scene.exposure = *first_view.exposure;
    if (first_view.tone) scenario.scene.tone = *first_view.tone;
    return scenario;
  };
  const viewer::TankViewerReport report = viewer::run_tank_viewer(make, !options.play.empty(), viewer);
  write_tank_report(options.json, report);
  expect_no_messages(report.validation_messages);
}

}  // namespace brume::cli
