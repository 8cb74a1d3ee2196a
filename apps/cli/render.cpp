#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "apps/cli/command.hpp"
#include "apps/cli/flipbook.hpp"
#include "apps/cli/orbit.hpp"
#include "apps/cli/render_options.hpp"
#include "apps/cli/render_output.hpp"
#include "apps/cli/render_tank.hpp"
#include "apps/cli/stopwatch.hpp"
#include "apps/cli/timed_playback.hpp"
#include "apps/command_line/console.hpp"
#include "apps/command_line/json.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/hash.hpp"
#include "core/log.hpp"
#include "core/utf8.hpp"
#include "film/playback.hpp"
#include "gpu/context.hpp"
#include "grids/files/grid_files.hpp"
#include "render/volume_room.hpp"
#include "scenario/tank.hpp"
#include "scene/text_reader.hpp"

namespace brume::cli {
namespace {

// After a signal a checkpoint takes its time [s].
constexpr double kCheckpointGrace = 8;

// What --raycast cannot draw.
void check_raycast(const RenderOptions& options, const scenario::Scenario& scenario) {
  const scene::Timeline& timeline = scenario.timeline;
  if (options.raycast.empty()) return;
  if (timeline.volumes.empty())
    throw Error(ErrorCode::usage, "--raycast: " + options.input + " has no volume; remove the option");
  for (const scene::VolumeOptions& volume : timeline.volumes)
    if (!volume.opacity.empty() || !volume.color_map.empty() || volume.glow > 0)
      throw Error(ErrorCode::usage, "--raycast: draws no transfer functions; remove the option, or that of " +
                                        volume.file.filename().string());
  for (std::size_t i = 0; i < timeline.volumes.size(); ++i)
    if (scenario.volumes && scenario.volumes->typical_frame(i).heat)
      log_warning("--raycast draws nothing that glows: " + timeline.volumes[i].file.filename().string());
  if (!timeline.smokes.empty())
    log_warning("--raycast draws volumes alone: the smoke of the timeline is not shown");
}

// Debug views of the smoke show nothing without any.
void check_view(const RenderOptions& options, const Plan& plan, const scenario::Scenario& scenario) {
  if (!scenario.timeline.smokes.empty()) return;
  using passes::DebugView;
  for (const DebugView view :
       {DebugView::distance, DebugView::density, DebugView::light, DebugView::holes, DebugView::bricks})
    if (plan.view == view)
      throw Error(ErrorCode::usage,
                  "--view " + options.view + ": shows smoke, and " + options.input + " has none" +
                      (scenario.timeline.volumes.empty() ? "; give --smoke or another view"
                                                         : "; volumes are in --view steps"));
}

// What both modes start from.
struct Loaded {
  scenario::Scenario scenario;
  std::unique_ptr<scenario::Simulation> simulation;
  std::optional<Orbit> orbit;
  Json smokes;
};

// What is drawn of each file of grids, and how.
Json report_volumes(const scenario::Scenario& scenario) {
  Json volumes = Json::list({});
  for (std::size_t i = 0; i < scenario.timeline.volumes.size(); ++i) {
    const scene::VolumeOptions& volume = scenario.timeline.volumes[i];
    const volumes::VolumeFrame& frame = scenario.volumes->typical_frame(i);
    volumes.push_back({{"file", volume.file.string()},
                       {"density", frame.density_name},
                       {"extinction", double{volume.extinction}},
                       {"scale", double{volume.scale}},
                       {"heat", frame.heat_note}});
  }
  return volumes;
}

double duration_of(const Loaded& loaded) {
  return double{loaded.scenario.timeline.duration};
}

Film film_of(const Loaded& loaded, std::vector<std::string> device) {
  return {duration_of(loaded), scenario::files_of(loaded.scenario), std::move(device)};
}

// Whether frames at different times differ, but for the camera.
bool plays(const scenario::Scenario& scenario) {
  const scene::Timeline& timeline = scenario.timeline;
  for (std::size_t i = 0; i < timeline.volumes.size(); ++i)
    if (scenario.volumes->is_sequence(i)) return true;
  return !timeline.smokes.empty() || !timeline.carriers.empty();
}

void simulate(const RenderOptions& options, const Plan& plan, Loaded& loaded) {
  loaded.simulation = scenario::Simulation::create(loaded.scenario).value_or_throw();
  check_raycast(options, loaded.scenario);
  loaded.smokes = report_timeline(loaded.scenario, loaded.simulation->report_smokes(loaded.scenario));
  stop_if_interrupted();
  if (options.orbit)
    loaded.orbit.emplace(loaded.scenario, plan.camera, *options.orbit, frames_of(plan, duration_of(loaded)),
                         plan.scene.aspect);
}

// Where the camera is as long as it does not turn; empty: on the timeline's path.
scenario::CameraAt camera_before(const Plan& plan, const Loaded& loaded) {
  const std::optional<scene::Camera>& camera = loaded.orbit ? loaded.orbit->still_camera() : plan.camera;
  if (!camera) return {};
  return [still = *camera](double) { return still; };
}

// The camera of --orbit around the time of a frame.
scenario::CameraAt orbiting(const Plan& plan, const Orbit& orbit, double seconds, std::uint32_t frame) {
  return [&orbit, seconds, frame, rate = plan.rate.per_second()](double at) {
    return orbit.at(at, frame + (at - seconds) * rate);
  };
}

// --shutter replaces the shutter time of all cameras.
void set_shutter(const RenderOptions& options, Plan& plan, scenario::Scenario& scenario) {
  if (!options.shutter) return;
  const auto seconds = static_cast<float>(*options.shutter);
  scenario.camera.shutter = seconds;
  if (plan.camera) plan.camera->shutter = seconds;
  for (scene::CameraKey& key : scenario.timeline.camera) key.camera.shutter = seconds;
}

/// Frames of the path tracer.
class TracedFrames final : public FrameSource {
 public:
  TracedFrames(const RenderOptions& options, const Plan& plan, Loaded& loaded)
      : plan_(plan),
        orbit_(loaded.orbit),
        frames_(loaded.scenario, std::move(loaded.simulation), options.reference,
                {plan.renderer.size_px, options.samples, plan.layers, key_of(options, loaded)}) {
    frames_.set_camera(camera_before(plan, loaded));
  }
  Picture draw(double seconds, std::uint32_t frame) override {
    if (orbit_) frames_.set_camera(orbiting(plan_, *orbit_, seconds, frame));
    return frames_.draw(seconds);
  }
  void set_camera(const scene::Camera& camera) override {
    frames_.set_camera([camera](double) { return camera; });
  }
  image::Display display() const override { return frames_.display(); }
  Json statistics() const override { return frames_.statistics(); }

 private:
  // The key of what a checkpoint depends on; it knows its limits itself.
  static std::uint64_t key_of(const RenderOptions& options, const Loaded& loaded) {
    RenderOptions without_limits = options;
    without_limits.reference = {};
    without_limits.reference.matte = options.reference.matte;
    without_limits.samples.reset();
    const std::vector<std::string> device{"reference",
                                          exact_text(picture_time(options, duration_of(loaded)))};
    return checkpoint_key(sequence_key(without_limits, scenario::files_of(loaded.scenario), device, {}));
  }

  const Plan& plan_;
  const std::optional<Orbit>& orbit_;
  ReferenceFrames frames_;
};

// Frames that depend on those before are single samples.
void warn_of_lens(const RenderOptions& options, const Plan& plan, const scenario::Scenario& scenario) {
  const auto is_sharp = [](const scene::Camera& camera) { return scenario::usual_samples(camera) == 1; };
  const auto& keys = scenario.timeline.camera;
  const bool all_sharp = plan.camera    ? is_sharp(*plan.camera)
                         : keys.empty() ? is_sharp(scenario.camera)
                                        : std::ranges::all_of(keys, is_sharp, &scene::CameraKey::camera);
  if (all_sharp) return;
  const char* const reason = options.temporal                    ? "--temporal"
                             : options.light_update_fraction < 1 ? "--light-update-fraction"
                             : options.view != "none"            ? "--view"
                                                                 : nullptr;
  if (reason)
    log_warning(std::string(reason) +
                " shows neither the aperture nor the shutter of the camera; all is sharp");
}

/// Frames of a device.
class DeviceFrames final : public FrameSource {
 public:
  DeviceFrames(gpu::Context& context, const RenderOptions& options, const Plan& plan, Loaded& loaded)
      : plan_(plan),
        orbit_(loaded.orbit),
        playback_(context, loaded.scenario, plan.renderer, std::move(loaded.simulation)) {
    playback_.set_camera(camera_before(plan, loaded));
    playback_.set_samples(frames_depend(options) ? 1 : options.samples);
    if (loaded.scenario.measure_exposure) playback_.measure_exposure();
    playback_.set_step_scale(options.step);
    playback_.set_light_update_fraction(options.light_update_fraction);
    playback_.set_resolve_error_scale(options.resolve_error_scale);
    playback_.set_view(plan.view, plan.slice);
  }
  Picture draw(double seconds, std::uint32_t frame) override {
    if (orbit_) playback_.set_camera(orbiting(plan_, *orbit_, seconds, frame));
    return timed_.draw(seconds, frame, plan_.layers ? &*plan_.layers : nullptr);
  }
  void set_camera(const scene::Camera& camera) override { playback_.set_camera(camera); }
  image::Display display() const override { return playback_.display(); }
  Json statistics() const override { return timed_.statistics(); }

 private:
  const Plan& plan_;
  const std::optional<Orbit>& orbit_;
  film::Playback playback_;
  TimedPlayback timed_{playback_};
};

/// Draws and writes frames that `make` makes, as the plan says; returns their statistics.
Json write_frames(const RenderOptions& options, const Plan& plan, CommonOptions& common, Loaded& loaded,
                  std::vector<std::string> device,
                  const std::function<std::unique_ptr<FrameSource>()>& make) {
  if (!plan.flipbook) {
    const auto frames = make();
    write(options, plan, common, film_of(loaded, std::move(device)),
          [&](double seconds, std::uint32_t i) { return frames->draw(seconds, i); });
    return frames->statistics();
  }
  scenario::Scenario& scenario = loaded.scenario;
  const FrameRange range = frames_of(plan, duration_of(loaded));
  const scenario::CameraAt still = camera_before(plan, loaded);
  const double begin = plan.rate.time_of(range.first);
  const bool is_sequence =
      scenario.timeline.smokes.empty() && scenario.timeline.carriers.empty() && !loaded.orbit;
  // What no one has chosen may be chosen better.
  const bool fits_camera =
      scenario.camera_is_fitted && scenario.timeline.camera.empty() && !plan.camera && !loaded.orbit;
  return write_flipbook(
      {.plan = *plan.flipbook,
       .range = range,
       .rate = plan.rate,
       .camera = still ? still(begin) : scene::camera_at(scenario.timeline, scenario.camera, begin),
       .is_still = !plays(scenario) && scenario.timeline.camera.size() < 2 && !loaded.orbit,
       .is_turn = loaded.orbit.has_value(),
       .is_sequence = is_sequence,
       .fits_camera = fits_camera,
       .frames_under = [&](const FlipbookLight& light) {
         set_light(light, scenario);
         if (!loaded.simulation) loaded.simulation = scenario::Simulation::create(scenario).value_or_throw();
         return make();
       }});
}

Json render_reference(const RenderOptions& options, const Plan& plan, CommonOptions& common, Loaded& loaded) {
  simulate(options, plan, loaded);
  if (!loaded.scenario.tanks.empty()) log_warning(options.input + ": --mode reference shows no [[tank]]");
  if (!options.reference.checkpoint.empty()) common.grace_seconds = kCheckpointGrace;
  Json statistics{{"mode", options.mode}};
  statistics.update(
      write_frames(options, plan, common, loaded, {"reference"}, [&]() -> std::unique_ptr<FrameSource> {
        return std::make_unique<TracedFrames>(options, plan, loaded);
      }));
  return statistics;
}

Json render_realtime(const RenderOptions& options, const Plan& plan, CommonOptions& common, Loaded& loaded) {
  gpu::Context context({options.device, false});
  if (loaded.scenario.volumes)
    loaded.scenario.volumes->limit(render::volume_room(context, std::uint64_t{options.volume_memory} << 20))
        .value_or_throw();
  simulate(options, plan, loaded);
  warn_of_lens(options, plan, loaded.scenario);
  Json statistics{{"mode", options.mode},
                  {"march", options.march},
                  {"temporal", options.temporal},
                  {"device", context.info().name},
                  {"driver", context.info().driver}};
  statistics.update(write_frames(options, plan, common, loaded, {context.info().name, context.info().driver},
                                 [&]() -> std::unique_ptr<FrameSource> {
                                   return std::make_unique<DeviceFrames>(context, options, plan, loaded);
                                 }));
  return statistics;
}

// A shard of more shards than frames requires no device, but the same options.
Json no_frames(const RenderOptions& options, const Loaded& loaded) {
  check_raycast(options, loaded.scenario);
  return {{"mode", options.mode}, {"frames", 0}};
}

void render(const Arguments& arguments, const RenderOptions& options, CommonOptions& common) {
  const Stopwatch watch;
  Plan plan = make_plan(arguments, options, common.outputs);
  if (scenario::is_tank_input(to_path(options.input))) return render_tank(arguments, options, plan, common);
  Loaded loaded{load_with_options(options.input, options.timeline, plan.scene), {}, {}, Json::list({})};
  check_view(options, plan, loaded.scenario);
  set_shutter(options, plan, loaded.scenario);
  // A turn around what stands still has a frame for each tile.
  if (plan.flipbook && options.orbit && !plan.frames && !plays(loaded.scenario))
    plan.frames = FrameRange{0, plan.flipbook->layout.tiles() - 1};
  if (plan.kind == TargetKind::sequence && !plan.frames)
    declare_frames(options, plan, frames_of(plan, duration_of(loaded)), common.outputs);
  common.outputs.reads(scenario::files_of(loaded.scenario));
  stop_if_interrupted();
  warn_of_times(options, plan, duration_of(loaded));
  const Json frames = !has_frames(plan, duration_of(loaded)) ? no_frames(options, loaded)
                      : is_reference(options)                ? render_reference(options, plan, common, loaded)
                                                             : render_realtime(options, plan, common, loaded);
  if (options.json.empty()) return;
  const glm::uvec2 size_px = plan.flipbook ? plan.flipbook->layout.sheet_px() : plan.renderer.size_px;
  Json statistics{{"output", options.output}, {"size", Json::list({size_px.x, size_px.y})}};
  statistics.update(frames);
  statistics.set("seconds", watch.seconds());
  statistics.set("smokes", loaded.smokes);
  statistics.set("volumes", report_volumes(loaded.scenario));
  write_json(options.json, statistics);
}

}  // namespace

Command add_render(CommandLine& program) {
  Command command = declare(
      program, "render", "Renders a scene or a timeline to an image, an image sequence or a film.",
      "  brume render room.glb -o room.png\n"
      "  brume render room.glb -o room.png --throw \"0,1.7,8 -2.6,0.4,-3\" --smoke-size 4\n"
      "  brume render scenes/demo.toml -o demo.png --time 2.5 --size 1920x1080\n"
      "  brume render scenes/demo.toml -o demo.mp4 --frames 0-47 --fps 24 --size 640x360\n"
      "  brume render cloud.vdb -o turntable.mp4 --orbit 360 --frames 0-239\n"
      "  brume render smoke_%04d.vdb -o sheet.png --flipbook 8x8 --flipbook-maps six-way,motion\n"
      "  brume render scenes/demo.toml -o demo.exr --time 2.5\n"
      "  brume render scenes/demo.toml -o truth.png --time 2.5 --mode reference --samples 8 --size 320x180\n"
      "  brume render scenes/demo.toml -o demo_%04d.png --camera \"0,1.7,8 0,1.5,0 60\"");
  auto options = std::make_shared<RenderOptions>();
  const Arguments arguments = command.arguments;
  declare_render(arguments, *options);
  command.run = [arguments, options, common = command.common] { render(arguments, *options, *common); };
  return command;
}

}  // namespace brume::cli
