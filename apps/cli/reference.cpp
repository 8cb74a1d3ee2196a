#include "apps/cli/reference.hpp"

#include <cmath>
#include <cstdio>

#include "apps/cli/console.hpp"
#include "apps/cli/stopwatch.hpp"
#include "core/progress.hpp"
#include "planning/device_camera.hpp"
#include "planning/scenario_frame.hpp"
#include "reference/motion.hpp"
#include "reference/picture.hpp"
#include "scene/text_reader.hpp"

namespace brume::cli {
namespace {

constexpr std::uint32_t kDefaultSamples = 64;
/// Between checkpoints, at least and at most [s].
constexpr double kLeastInterval = 0.2, kMostInterval = 30;

/// The progress of a picture towards whichever limit it has.
class PictureProgress {
 public:
  explicit PictureProgress(const ReferenceOptions& options, std::uint32_t samples)
      : options_(options),
        samples_(samples),
        job_(options.time_limit && samples == 0 ? "seconds" : "samples", samples) {
    if (options.time_limit && samples == 0)
      job_.set_total(static_cast<std::uint64_t>(std::ceil(*options.time_limit)));
  }
  void show(const reference::Render& render, double seconds) {
    const double error = render.error();
    double done = render.samples();
    if (samples_ == 0 && options_.time_limit) done = seconds;
    // Errors fall with the root of the number of samples.
    if (samples_ == 0 && options_.noise && std::isfinite(error))
      job_.set_total(
          static_cast<std::uint64_t>(std::ceil(done * std::max(1.0, std::pow(error / *options_.noise, 2)))));
    const auto whole = static_cast<std::uint64_t>(done);
    if (whole > shown_) job_.advance(whole - shown_);
    shown_ = std::max(shown_, whole);
    char text[64] = "";
    if (std::isfinite(error)) std::snprintf(text, sizeof text, "error %.3g %%", 100 * error);
    job_.set_detail(text);
  }

 private:
  const ReferenceOptions& options_;
  std::uint32_t samples_;
  Progress job_;
  std::uint64_t shown_ = 0;
};

/// A camera whose lens knows what is sharp.
reference::Eye eye_of(const scene::Camera& camera, glm::uvec2 size_px) {
  reference::Eye eye{planning::device_camera(camera, size_px), camera.lens};
  if (!(eye.lens.focus > 0)) eye.lens.focus = glm::distance(camera.position_world, camera.target_world);
  return eye;
}

}  // namespace

void declare_reference(const Arguments& arguments, ReferenceOptions& options) {
  arguments
      .add_option("--samples", options.samples,
                  "Paths per pixel of --mode reference; default 64, if no other limit is given")
      .range(1u, reference::kMostSamples)
      .type_name("N");
  arguments
      .add_option("--noise", options.noise,
                  "Relative standard error at which a part of the picture is done, such as 0.02")
      .range(1e-4, 1.0)
      .type_name("E");
  arguments
      .add_option("--time-limit", options.time_limit, "Time to render each picture of --mode reference [s]")
      .range(0.01, 1e7)
      .type_name("S");
  arguments
      .add_option("--shutter", options.shutter,
                  "Time that the shutter stays open from the picture's on, for motion blur [s]; default 0")
      .range(0.0, 10.0)
      .type_name("S");
  arguments
      .add_option("--max-bounces", options.max_bounces,
                  "Scatterings of a path at most (biased); 1: light that is scattered once")
      .range(0u, 1u << 20)
      .type_name("N");
  arguments
      .add_option("--clamp", options.clamp,
                  "Largest radiance that a path adds after its first bounce (biased)")
      .range(1e-6, 1e9)
      .type_name("L");
  arguments.add_flag("--matte", options.matte,
                     "All surfaces follow Lambert's law, without highlights (not as --mode realtime)");
  arguments
      .add_option("--checkpoint", options.checkpoint,
                  "Keep the samples in a file, from which the same command goes on")
      .type_name("FILE");
}

std::vector<std::string> texts_of(const ReferenceOptions& options) {
  const auto text = [](const auto& number) {
    return number ? scene::shown(static_cast<double>(*number)) : std::string();
  };
  return {text(options.samples),       text(options.noise), text(options.time_limit),
          text(options.max_bounces),   text(options.clamp), text(options.shutter),
          options.matte ? "matte" : ""};
}

ReferenceFrames::ReferenceFrames(const scenario::Scenario& scenario,
                                 std::unique_ptr<scenario::Simulation> simulation,
                                 const ReferenceOptions& options, glm::uvec2 size_px, bool has_layers,
                                 std::uint64_t key)
    : scenario_(scenario),
      simulation_(std::move(simulation)),
      options_(options),
      size_px_(size_px),
      has_layers_(has_layers),
      key_(key) {}

void ReferenceFrames::measure_exposure() {
  const double end = double{scenario_.timeline.duration};
  simulation_->advance_to(end);
  std::vector<shared::Hole> holes;
  planning::FrameInput frame = frame_at(end, holes);
  exposure_ = reference::measure_exposure(scenario_.scene, frame, &scenario_.masks,
                                          static_cast<float>(size_px_.x) / static_cast<float>(size_px_.y));
}

planning::FrameInput ReferenceFrames::frame_at(double seconds, std::vector<shared::Hole>& holes) const {
  planning::FrameInput frame =
      planning::frame_input(scenario_, *simulation_, seconds, holes, {.particles = false});
  if (camera_) frame.view.camera = *camera_;
  return frame;
}

/// Where all is while the shutter is open. To be called before frame_at for its beginning, since another
/// frame of a sequence of volumes may replace the one before.
std::vector<planning::FrameInput> ReferenceFrames::frames_until(double seconds) const {
  std::vector<planning::FrameInput> later;
  if (options_.shutter.value_or(0) <= 0) return later;
  constexpr std::size_t kSteps = reference::kMostSteps - 1;
  for (std::size_t step = 1; step <= kSteps; ++step) {
    std::vector<shared::Hole> holes;
    later.push_back(frame_at(seconds + *options_.shutter * static_cast<double>(step) / kSteps, holes));
    later.back().smoke = {};  // Its holes end here.
  }
  return later;
}

Picture ReferenceFrames::draw(double seconds) {
  const Stopwatch watch;
  if (scenario_.measure_exposure && !exposure_) measure_exposure();
  simulation_->advance_to(seconds);
  std::vector<shared::Hole> holes;
  const std::vector<planning::FrameInput> later = frames_until(seconds);
  planning::FrameInput frame = frame_at(seconds, holes);
  if (exposure_) frame.view.exposure = *exposure_;
  const auto scene = reference::make_scene(scenario_.scene, frame, &scenario_.masks, options_.matte, later);

  reference::RenderSettings settings;
  settings.size_px = size_px_;
  settings.eyes.push_back(eye_of(frame.view.camera, size_px_));
  for (const planning::FrameInput& step : later) settings.eyes.push_back(eye_of(step.view.camera, size_px_));
  if (options_.max_bounces) settings.limits.max_bounces = *options_.max_bounces;
  if (options_.clamp) settings.limits.clamp = static_cast<float>(*options_.clamp);
  if (options_.noise) settings.noise = static_cast<float>(*options_.noise);
  const bool unlimited = !options_.noise && !options_.time_limit;
  settings.samples = options_.samples.value_or(unlimited ? kDefaultSamples : 0);
  reference::Render render(*scene, settings);
  const std::string& checkpoint = options_.checkpoint;
  if (!checkpoint.empty() && std::filesystem::exists(checkpoint))
    render.load(checkpoint, key_).value_or_throw();

  PictureProgress progress(options_, settings.samples);
  const Stopwatch sampling;
  Stopwatch since_saved;
  double interval = kLeastInterval;
  const auto is_over = [&] {
    return is_interrupted() || (options_.time_limit && sampling.seconds() >= *options_.time_limit);
  };
  for (bool done = false; !done && !is_over();) {
    done = render.advance(0.1, is_over);
    progress.show(render, sampling.seconds());
    if (checkpoint.empty() || (!done && !is_over() && since_saved.seconds() < interval)) continue;
    const Stopwatch saving;
    render.save(checkpoint, key_).value_or_throw();
    // A hundredth of the time.
    interval = std::clamp(100 * saving.seconds(), kLeastInterval, kMostInterval);
    since_saved = {};
  }
  stop_if_interrupted();
  ++frames_;
  samples_ += render.samples();
  error_ = std::max(error_, render.error());
  seconds_ += watch.seconds();
  cpu_seconds_ += watch.cpu_seconds();
  if (has_layers_) return render.layers();
  return reference::picture_of(render, size_px_, frame.view);
}

Json ReferenceFrames::statistics() const {
  const double frames = std::max(frames_, 1u);
  return {{"frames", frames_},
          {"seconds_per_frame", seconds_ / frames},
          {"cpu_seconds_per_frame", cpu_seconds_ / frames},
          {"samples_per_pixel", samples_ / frames},
          {"largest_relative_error", error_}};
}

}  // namespace brume::cli
