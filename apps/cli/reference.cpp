#include "apps/cli/reference.hpp"

#include <cmath>
#include <cstdio>

#include "apps/cli/stopwatch.hpp"
#include "apps/command_line/console.hpp"
#include "apps/command_line/unit_key.hpp"
#include "core/log.hpp"
#include "core/progress.hpp"
#include "core/utf8.hpp"
#include "reference/picture.hpp"
#include "scenario/frame.hpp"
#include "scene/text_reader.hpp"
#include "surfaces/motion.hpp"

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

}  // namespace

void declare_reference(const Arguments& arguments, ReferenceOptions& options) {
  // When a picture is done.
  arguments
      .add_option("--noise", options.noise,
                  "Relative standard error at which a part of the picture is done, such as 0.02")
      .range(1e-4, 1.0)
      .type_name("E");
  arguments
      .add_option("--time-limit", options.time_limit, "Time to render each picture of --mode reference [s]")
      .range(0.01, 1e7)
      .type_name("S");
  // What makes pictures faster or plainer.
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

std::vector<std::string> to_texts(const ReferenceOptions& options) {
  const auto text = [](const auto& number) {
    return number ? exact_text(static_cast<double>(*number)) : std::string();
  };
  return {text(options.noise), text(options.time_limit), text(options.max_bounces), text(options.clamp),
          options.matte ? "matte" : ""};
}

ReferenceFrames::ReferenceFrames(const scenario::Scenario& scenario,
                                 std::unique_ptr<scenario::Simulation> simulation,
                                 const ReferenceOptions& options, const FrameSettings& frames)
    : scenario_(scenario), simulation_(std::move(simulation)), options_(options), settings_(frames) {}

/// In at most half of the time limit.
void ReferenceFrames::measure_exposure(const Stopwatch& watch) {
  const double end = double{scenario_.timeline.duration};
  simulation_->advance_to(end);
  std::vector<shared::Hole> holes;
  planning::FrameInput frame = frame_at(end, holes);
  exposure_ = reference::measure_exposure(
      scenario_.scene, frame, &scenario_.masks,
      static_cast<float>(settings_.size_px.x) / static_cast<float>(settings_.size_px.y), [&] {
        return is_interrupted() || (options_.time_limit && watch.seconds() >= *options_.time_limit / 2);
      });
  stop_if_interrupted();
}

planning::FrameInput ReferenceFrames::frame_at(double seconds, std::vector<shared::Hole>& holes) const {
  return scenario::frame_input(scenario_, *simulation_, seconds, holes, frame_options_);
}

/// Where all is at further steps while the shutter is open.
std::vector<planning::FrameInput> ReferenceFrames::frames_after(double seconds,
                                                                const planning::FrameInput& frame) const {
  std::vector<planning::FrameInput> later;
  const double shutter = double{frame.view.camera.shutter};
  if (shutter <= 0) return later;
  constexpr std::size_t kSteps = surfaces::kMostSteps - 1;
  for (std::size_t step = 1; step <= kSteps; ++step) {
    later.push_back(frame);
    scenario::move_frame(scenario_, seconds, seconds + shutter * static_cast<double>(step) / kSteps,
                         frame_options_, later.back());
  }
  return later;
}

reference::RenderSettings ReferenceFrames::settings_of(const planning::FrameInput& frame,
                                                       std::span<const planning::FrameInput> later) const {
  reference::RenderSettings settings;
  settings.size_px = settings_.size_px;
  const scene::Lens& lens = frame.view.camera.lens;
  settings.blades = lens.blades;
  settings.opening = scenario::opening_of(scenario_.lens_openings, lens);
  settings.eyes.push_back(reference::make_eye(frame.view.camera, settings_.size_px));
  for (const planning::FrameInput& step : later)
    settings.eyes.push_back(reference::make_eye(step.view.camera, settings_.size_px));
  if (options_.max_bounces) settings.limits.max_bounces = *options_.max_bounces;
  if (options_.clamp) settings.limits.clamp = static_cast<float>(*options_.clamp);
  if (options_.noise) settings.noise = static_cast<float>(*options_.noise);
  settings.samples = most_samples(options_, settings_.samples, kDefaultSamples);
  return settings;
}

void add_samples(reference::Render& render, const ReferenceOptions& options, std::uint32_t samples,
                 std::uint64_t key, double spent) {
  const std::string& checkpoint = options.checkpoint;
  if (!checkpoint.empty() && std::filesystem::exists(to_path(checkpoint)))
    render.load(to_path(checkpoint), key).value_or_throw();
  PictureProgress progress(options, samples);
  const Stopwatch sampling;
  Stopwatch since_saved;
  double interval = kLeastInterval;
  const auto is_over = [&] {
    return is_interrupted() || (options.time_limit && spent + sampling.seconds() >= *options.time_limit);
  };
  for (bool done = false; !done && !is_over();) {
    done = render.advance(0.1, is_over);
    progress.show(render, sampling.seconds());
    if (checkpoint.empty() || (!done && !is_over() && since_saved.seconds() < interval)) continue;
    const Stopwatch saving;
    render.save(to_path(checkpoint), key).value_or_throw();
    // A hundredth of the time.
    interval = std::clamp(100 * saving.seconds(), kLeastInterval, kMostInterval);
    since_saved = {};
  }
  stop_if_interrupted();
  if (const double without = render.without_samples(); without > 0) {
    char text[16];
    std::snprintf(text, sizeof text, "%.2g", 100 * without);
    log_warning("--time-limit " + exact_text(*options.time_limit) + ": ended before " + text +
                " % of the picture had a sample, which is black");
  }
}

std::uint32_t most_samples(const ReferenceOptions& options, std::optional<std::uint32_t> samples,
                           std::uint32_t usual) {
  const bool unlimited = !options.noise && !options.time_limit;
  return samples.value_or(unlimited ? usual : 0);
}

Picture ReferenceFrames::draw(double seconds) {
  const Stopwatch watch;
  double measuring = 0;
  if (scenario_.measure_exposure && !exposure_) {
    measure_exposure(watch);
    measuring = watch.seconds();
  }
  simulation_->advance_to(seconds);
  std::vector<shared::Hole> holes;
  planning::FrameInput frame = frame_at(seconds, holes);
  if (exposure_) frame.view.exposure = *exposure_;
  const std::vector<planning::FrameInput> later = frames_after(seconds, frame);
  const auto scene = reference::make_scene(scenario_.scene, frame, &scenario_.masks, options_.matte, later);
  const reference::RenderSettings settings = settings_of(frame, later);
  reference::Render render(*scene, settings);
  add_samples(render, options_, settings.samples, settings_.key, measuring);
  ++frames_;
  samples_ += render.samples();
  error_ = std::max(error_, render.error());
  seconds_ += watch.seconds();
  cpu_seconds_ += watch.cpu_seconds();
  display_ = {frame.view.exposure, static_cast<std::uint32_t>(frame.view.tone)};
  if (settings_.layers) return to_picture(render.layers(), *settings_.layers, display_);
  return reference::make_picture(render, settings_.size_px, frame.view);
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
