#include "apps/cli/render_tank.hpp"

#include <cmath>

#include "apps/cli/orbit.hpp"
#include "apps/cli/render_output.hpp"
#include "apps/cli/stopwatch.hpp"
#include "apps/cli/tank_options.hpp"
#include "apps/command_line/console.hpp"
#include "apps/command_line/json.hpp"
#include "core/utf8.hpp"
#include "film/tank_playback.hpp"
#include "gpu/context.hpp"
#include "reference/picture.hpp"
#include "reference/tank_tracer.hpp"
#include "scene/text_reader.hpp"

namespace brume::cli {
namespace {

// What is drawn, and how.
struct TankJob {
  const RenderOptions& options;
  const Plan& plan;
  CommonOptions& common;
  const scenario::TankScenario& scenario;

  std::optional<Orbit> orbit = std::nullopt;

  double duration() const { return double{scenario.scene.duration}; }
  scene::Camera camera_of_scene(double seconds) const {
    return scene::camera_at(scenario.scene, planning::size_of(scenario.tank), seconds);
  }
  scene::Camera camera_at(double seconds, std::uint32_t frame) const {
    return orbit ? orbit->at(seconds, frame) : plan.camera.value_or(camera_of_scene(seconds));
  }
  Film film(std::vector<std::string> device) const {
    return {duration(), scenario::files_of(scenario.scene), std::move(device)};
  }
};

Json render_on_device(const TankJob& job) {
  gpu::Context context({job.options.device, false});
  film::TankPlayback playback(context, job.scenario, job.plan.renderer.size_px);
  if (job.options.samples) playback.set_samples(*job.options.samples);
  const Stopwatch drawing;
  write(job.options, job.plan, job.common, job.film({context.info().name, context.info().driver}),
        [&](double seconds, std::uint32_t frame) -> Picture {
          playback.set_camera(job.camera_at(seconds, frame));
          Picture picture = job.plan.has_layers ? Picture(playback.draw_layers(seconds, is_interrupted))
                                                : Picture(playback.draw(seconds, is_interrupted));
          stop_if_interrupted();
          return picture;
        });
  Json passes = Json::object();
  for (const auto& scope : playback.timings()) passes.set(std::string(scope.name), scope.milliseconds);
  return {{"device", context.info().name},
          {"driver", context.info().driver},
          {"samples_per_pixel", playback.samples()},
          {"seconds_drawing", drawing.seconds()},
          {"gpu_milliseconds_of_last_samples", passes}};
}

Json render_by_paths(const TankJob& job) {
  const glm::uvec2 size_px = job.plan.renderer.size_px;
  const std::uint32_t samples =
      most_samples(job.options.reference, job.options.samples, job.scenario.scene.samples);
  double drawn = 0;
  // The key of a checkpoint has no limits of samples: a later run may raise them.
  RenderOptions without_limits = job.options;
  without_limits.reference = {};
  without_limits.reference.max_bounces = job.options.reference.max_bounces;
  without_limits.samples.reset();
  write(job.options, job.plan, job.common, job.film({"reference"}),
        [&](double seconds, std::uint32_t frame) -> Picture {
          const scene::TankScene now = reference::scene_at(job.scenario.scene, seconds);
          const reference::TankModel model(job.scenario.tank, now);
          const scene::Camera camera = job.camera_at(seconds, frame);
          // Paths of the tank as it is now, until the limits are reached.
          reference::RenderSettings settings;
          settings.size_px = size_px;
          settings.blades = camera.lens.blades;
          settings.eyes = {reference::make_eye(camera, size_px)};
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
          return reference::make_picture(render, size_px, view);
        });
  return {{"samples_per_pixel", drawn}};
}

}  // namespace

void render_tank(const Arguments& arguments, const RenderOptions& options, const Plan& plan,
                 CommonOptions& common) {
  const Stopwatch watch;
  // The tank, the cameras, and how many frames there are.
  refuse_options_of_levels(arguments);
  scenario::TankScenario scenario = load_tank(to_path(options.input), plan.scene, is_interrupted);
  if (options.reference.max_bounces) scenario.scene.bounces = *options.reference.max_bounces;
  stop_if_interrupted();
  TankJob job{options, plan, common, scenario};
  if (options.orbit)
    job.orbit.emplace([&](double seconds) { return job.camera_of_scene(seconds); },
                      plan.camera || scenario.scene.camera.size() > 1 ? plan.camera : job.camera_of_scene(0),
                      *options.orbit, frames_of(plan, job.duration()));
  if (plan.kind == TargetKind::sequence && !plan.frames)
    declare_frames(options, plan, frames_of(plan, job.duration()), common.outputs);
  warn_of_times(options, plan, job.duration());

  // The frames, and what they cost.
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
