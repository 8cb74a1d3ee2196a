#include "apps/cli/render_tank.hpp"

#include "apps/cli/console.hpp"
#include "apps/cli/json.hpp"
#include "apps/cli/render_output.hpp"
#include "apps/cli/stopwatch.hpp"
#include "gpu/context.hpp"
#include "render/tank_pictures.hpp"

namespace brume::cli {
namespace {

// What is for levels and their smoke.
void refuse_options_of_levels(const Arguments& arguments) {
  for (const char* option : {"--timeline",
                             "--march",
                             "--raycast",
                             "--temporal",
                             "--step",
                             "--resolve-error-scale",
                             "--light-update-fraction",
                             "--volume-memory",
                             "--view",
                             "--slice",
                             "--shutter",
                             "--orbit",
                             "--color-map",
                             "--opacity",
                             "--range",
                             "--voxel",
                             "--scale",
                             "--smoke",
                             "--throw",
                             "--smoke-size",
                             "--sun"})
    arguments.refuse(option, "is not for a tank of spheres");
}

}  // namespace

void render_tank(const Arguments& arguments, const RenderOptions& options, const Plan& plan,
                 CommonOptions& common) {
  const Stopwatch watch;
  refuse_options_of_levels(arguments);
  scenario::TankScenario scenario =
      scenario::load_tank_scenario(options.input, is_interrupted).value_or_throw();
  if (plan.scene.exposure) scenario.scene.exposure = *plan.scene.exposure;
  if (plan.scene.tone) scenario.scene.tone = *plan.scene.tone;
  stop_if_interrupted();
  const double duration = double{scenario.scene.duration};
  if (plan.kind == TargetKind::sequence && !plan.frames) {
    const FrameRange range = frames_of(plan, duration);
    common.outputs.writes_frames("-o", options.output, target_file_kind(options.output), range.first,
                                 range.last);
  }
  common.outputs.reads(scenario::files_of(scenario.scene));
  warn_of_times(options, plan, duration);

  gpu::Context context({options.device, false});
  render::TankPictures pictures(context, scenario, plan.renderer.size_px);
  pictures.set_camera(plan.camera);
  if (options.samples) pictures.set_samples(*options.samples);
  const Film film{duration, scenario::files_of(scenario.scene), {context.info().name, context.info().driver}};
  const Stopwatch drawing;
  write(options, plan, common, film, [&](double seconds, std::uint32_t) -> Picture {
    Picture picture = plan.has_layers() ? Picture(pictures.draw_layers(seconds, is_interrupted))
                                        : Picture(pictures.draw(seconds, is_interrupted));
    stop_if_interrupted();
    return picture;
  });

  if (options.json.empty()) return;
  Json passes = Json::object();
  for (const auto& scope : pictures.timings()) passes.set(scope.name, scope.milliseconds);
  write_json(options.json, Json{{"output", options.output},
                                {"size", Json::list({plan.renderer.size_px.x, plan.renderer.size_px.y})},
                                {"mode", options.mode},
                                {"device", context.info().name},
                                {"driver", context.info().driver},
                                {"spheres", scenario.tank.spheres.size()},
                                {"samples_per_pixel", pictures.samples()},
                                {"seconds_drawing", drawing.seconds()},
                                {"gpu_milliseconds_of_last_samples", passes},
                                {"seconds", watch.seconds()}});
}

}  // namespace brume::cli
