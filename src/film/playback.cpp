#include "film/playback.hpp"

#include <algorithm>
#include <utility>

#include "core/progress.hpp"
#include "film/exposure.hpp"
#include "film/layer_mean.hpp"
#include "film/read_back.hpp"
#include "planning/device_camera.hpp"

namespace brume::film {
namespace {

constexpr float kStepScaleOfOneSample = 0.5f;
/// Transmittance at which rays end in files that are graded later: five stops up show no edge there.
constexpr float kOpaqueForGrading = 1e-4f;

render::RendererOptions with_masks(render::RendererOptions options, const scenario::Scenario& scenario) {
  options.smoke.masks = &scenario.masks;
  return options;
}

}  // namespace

Playback::Playback(gpu::Context& context, const scenario::Scenario& scenario,
                   const render::RendererOptions& options)
    : Playback(context, scenario, options, scenario::Simulation::create(scenario).value_or_throw()) {}

Playback::Playback(gpu::Context& context, const scenario::Scenario& scenario,
                   const render::RendererOptions& options, std::unique_ptr<scenario::Simulation> simulation)
    : context_(context),
      scenario_(scenario),
      simulation_(std::move(simulation)),
      runner_(context),
      renderer_(context, runner_, scenario.scene, with_masks(options, scenario)),
      pixels_(gpu::readback_buffer(context, std::size_t{4} * options.size_px.x * options.size_px.y)),
      list_(gpu::readback_buffer(context, sizeof(shared::MarchList))) {}

void Playback::measure_exposure() {
  const double seconds = double{scenario_.timeline.duration};
  simulation_->advance_to(seconds);
  std::vector<shared::Hole> holes;
  const planning::FrameInput input = scenario::frame_input(scenario_, *simulation_, seconds, holes, options_);
  exposure_ = film::measure_exposure(context_, renderer_, input);
}

double Playback::fraction_marched() const {
  if (!renderer_.march().tiles()) return 1;
  const shared::MarchList& list = gpu::values_of<shared::MarchList>(list_).front();
  const glm::uvec2 blocks(renderer_.march().tiles()->far.info().size);
  return static_cast<double>(list.count) / (static_cast<double>(blocks.x) * blocks.y);
}

void Playback::draw_frame(double seconds, std::uint32_t frame_index, const EachSample& each) {
  const Progress job("render");
  simulation_->advance_to(seconds);
  std::vector<shared::Hole> holes;
  planning::FrameInput input = scenario::frame_input(scenario_, *simulation_, seconds, holes, options_);
  input.quality.step_scale = step_scale_;
  input.quality.light_update_fraction = light_update_fraction_;
  input.quality.resolve_error_scale = resolve_error_scale_;
  if (each.for_grading)
    input.smoke.look.opaque_transmittance =
        std::min(input.smoke.look.opaque_transmittance, kOpaqueForGrading);
  input.view.continues = last_frame_index_ && frame_index == *last_frame_index_ + 1;
  last_frame_index_ = frame_index;
  if (exposure_) input.view.exposure = *exposure_;
  input.debug = debug_;
  display_ = {input.view.exposure, static_cast<std::uint32_t>(input.view.tone)};
  scenario::FrameSamples samples(scenario_, seconds, options_, std::move(input),
                                 renderer_.march().is_accumulated() ? 1u : samples_);
  samples_drawn_ = samples.count();
  for (std::uint32_t i = 0; i < samples_drawn_; ++i) {
    const bool is_last = i + 1 == samples.count();
    planning::FrameInput sample = is_last ? std::move(samples)[i] : samples[i];
    // Samples smooth what is finer than a step. Of one alone it would be grain.
    if (samples_drawn_ == 1 && !renderer_.march().is_accumulated() && sample.smoke.look.detail > 0)
      sample.quality.step_scale *= kStepScaleOfOneSample;
    if (renderer_.is_antialiased() && sample.view.continues)
      sample.view.sample = planning::film_sample(frame_index);
    renderer_.draw(sample, [&](gpu::Recorder& recorder) {
      each.read_back(recorder, is_last);
      if (renderer_.march().tiles())
        recorder.read_back(renderer_.march().tiles()->list, list_, sizeof(shared::MarchList));
    });
    each.drawn();
  }
}

image::Image8 Playback::draw(double seconds, std::uint32_t frame_index) {
  draw_frame(seconds, frame_index, {[&](gpu::Recorder& recorder, bool is_last) {
               if (is_last) recorder.read_back(renderer_.targets().display, pixels_);
             }});
  return read_picture(pixels_, renderer_.targets().size_px);
}

image::LayeredImage Playback::draw_layers(double seconds, std::uint32_t frame_index) {
  BRUME_ASSERT(debug_.view == passes::DebugView::none, "a debug view has no radiance");
  if (!layers_) layers_.emplace(context_, renderer_.targets().size_px);
  LayerMean mean;
  draw_frame(seconds, frame_index,
             {[&](gpu::Recorder& recorder, bool) { layers_->record(recorder, renderer_); },
              [&] { mean.add(layers_->image()); }, true});
  return mean.mean();
}

}  // namespace brume::film
