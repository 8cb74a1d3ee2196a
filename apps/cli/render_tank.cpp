#include "apps/cli/render_tank.hpp"

#include <cmath>

#include "apps/cli/render_output.hpp"
#include "apps/cli/stopwatch.hpp"
#include "apps/command_line/console.hpp"
#include "apps/command_line/json.hpp"
#include "gpu/context.hpp"
#include "reference/picture.hpp"
#include "reference/tank_tracer.hpp"
#include "render/tank_pictures.hpp"
#include "scene/text_reader.hpp"

namespace brume::cli {
namespace {

// What is for levels and their smoke.
void refuse_options_of_levels(const Arguments& arguments) {
  for (const char* option : {"--timeline",
                             "--background",
                             "--flipbook",
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
                             "--sun",
                             "--bounces"})
    arguments.refuse(option, "is not for a tank of spheres");
}

// What is drawn, and how.
struct TankJob {
  const RenderOptions& options;
  const Plan& plan;
  CommonOptions& common;
  const scenario::TankScenario& scenario;

  double duration() const { return double{scenario.scene.duration}; }
  Film film(std::vector<std::string> device) const {
    return {duration(), scenario::files_of(scenario.scene), std::move(device)};
  }
};

Json render_on_device(const TankJob& job) {
  gpu::Context context({job.options.device, false});
  render::TankPictures pictures(context, job.scenario, job.plan.renderer.size_px);
  pictures.set_camera(job.plan.camera);
  if (job.options.samples) pictures.set_samples(*job.options.samples);
  const Stopwatch drawing;
  write(job.options, job.plan, job.common, job.film({context.info().name, context.info().driver}),
        [&](double seconds, std::uint32_t) -> Picture {
          Picture picture = job.plan.has_layers ? Picture(pictures.draw_layers(seconds, is_interrupted))
                                                : Picture(pictures.draw(seconds, is_interrupted));
          stop_if_interrupted();
          return picture;
        });
  Json passes = Json::object();
  for (const auto& scope : pictures.timings()) passes.set(std::string(scope.name), scope.milliseconds);
  return {{"device", context.info().name},
          {"driver", context.info().driver},
          {"samples_per_pixel", pictures.samples()},
          {"seconds_drawing", drawing.seconds()},
          {"gpu_milliseconds_of_last_samples", passes}};
}

Json render_by_paths(const TankJob& job) {
  const glm::uvec2 size_px = job.plan.renderer.size_px;
  const std::uint32_t samples =
      most_samples(job.options.reference, job.options.samples, job.scenario.scene.samples);
  double drawn = 0;
  RenderOptions without_limits = job.options;
  without_limits.reference = {};
  without_limits.samples.reset();
  write(job.options, job.plan, job.common, job.film({"reference"}),
        [&](double seconds, std::uint32_t) -> Picture {
          const scene::TankScene now = reference::scene_at(job.scenario.scene, seconds);
          const reference::TankModel model(job.scenario.tank, now);
          const scene::Camera camera =
              job.plan.camera.value_or(scene::camera_at(now, planning::size_of(job.scenario.tank), seconds));
          reference::RenderSettings settings;
          settings.size_px = size_px;
          settings.blades = camera.lens.blades;
          settings.eyes = {reference::eye_of(camera, size_px)};
          settings.samples = samples;
          if (job.options.reference.noise) settings.noise = static_cast<float>(*job.options.reference.noise);
          reference::Render render(reference::tank_trace(model), settings);
          const std::vector<std::string> texts{"reference", exact_text(seconds)};
          add_samples(render, job.options.reference, samples,
                      checkpoint_key(sequence_key(without_limits, job.film({}).files, texts, {})));
          drawn += render.samples();
          if (job.plan.has_layers) return render.layers();
          planning::View view;
          view.exposure = std::exp2(job.scenario.scene.exposure);
          view.tone = job.scenario.scene.tone;
          return reference::picture_of(render, size_px, view);
        });
  return {{"samples_per_pixel", drawn}};
}

}  // namespace

void render_tank(const Arguments& arguments, const RenderOptions& options, const Plan& plan,
                 CommonOptions& common) {
  const Stopwatch watch;
  refuse_options_of_levels(arguments);
  for (const char* option : {"--max-bounces", "--clamp", "--matte"})
    arguments.refuse(option, "is not for a tank of spheres; its [tank] says \"bounces\"");
  scenario::TankScenario scenario =
      scenario::load_tank_scenario(options.input, is_interrupted).value_or_throw();
  if (plan.scene.exposure) scenario.scene.exposure = *plan.scene.exposure;
  if (plan.scene.tone) scenario.scene.tone = *plan.scene.tone;
  stop_if_interrupted();
  const TankJob job{options, plan, common, scenario};
  if (plan.kind == TargetKind::sequence && !plan.frames)
    declare_frames(options, plan, frames_of(plan, job.duration()), common.outputs);
  warn_of_times(options, plan, job.duration());

  const Json frames = !has_frames(plan, job.duration()) ? Json{{"frames", 0}}
                      : is_reference(options)           ? render_by_paths(job)
                                                        : render_on_device(job);
  if (options.json.empty()) return;
  Json statistics{{"output", options.output},
                  {"size", Json::list({plan.renderer.size_px.x, plan.renderer.size_px.y})},
                  {"mode", options.mode},
                  {"spheres", scenario.tank.spheres.size()}};
  statistics.update(frames);
  statistics.set("seconds", watch.seconds());
  write_json(options.json, statistics);
}

}  // namespace brume::cli
