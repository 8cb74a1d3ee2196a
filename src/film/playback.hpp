// Plays a scenario on a device: draws any time of its timeline, by as many samples as that takes.
#pragma once

#include <memory>
#include <optional>

#include "film/frame_layers.hpp"
#include "image/image.hpp"
#include "image/texels.hpp"
#include "render/renderer.hpp"
#include "scenario/frame.hpp"
#include "scenario/simulation.hpp"

namespace brume::film {

/// A scenario on a device, frame after frame.
class Playback {
 public:
  /// `scenario` must outlive it. Throws what Renderer and Simulation::create throw.
  Playback(gpu::Context& context, const scenario::Scenario& scenario, const render::RendererOptions& options);
  /// With a simulation of the scenario, at any time.
  Playback(gpu::Context& context, const scenario::Scenario& scenario, const render::RendererOptions& options,
           std::unique_ptr<scenario::Simulation> simulation);
  Playback(gpu::Context& context, const scenario::Scenario& scenario, glm::uvec2 size_px)
      : Playback(context, scenario, render::RendererOptions{size_px}) {}

  /// The image at a time [s]: the same for the same time, whatever came before and whatever its index. With
  /// RendererOptions::temporal a frame whose index is one more than in the draw before goes on from it;
  /// any other starts over. The image of a camera with a lens or a shutter is the mean of its samples.
  image::Image8 draw(double seconds, std::uint32_t frame_index);
  /// The same frame as numbers (FrameLayers). Without a debug view, and with
  /// RendererOptions::smoke.record_entries.
  image::LayeredImage draw_layers(double seconds, std::uint32_t frame_index);
  /// Where the camera is at a time instead of on the timeline's path; empty: on the path.
  void set_camera(scenario::CameraAt camera) { options_.camera = std::move(camera); }
  /// The same camera at all times.
  void set_camera(const scene::Camera& camera) {
    set_camera([camera](double) { return camera; });
  }
  /// Samples of an image that follow, at least 1; empty: as many as are usual (scenario::usual_samples). With
  /// RendererOptions::temporal, 1.
  void set_samples(std::optional<std::uint32_t> samples) { samples_ = samples; }
  /// Sets the exposure that shows the scene at the timeline's end at a middle brightness, without smoke.
  /// Between frames; the frames that follow have it whatever their time.
  void measure_exposure();
  /// Quality::step_scale of the frames that follow.
  void set_step_scale(float scale) { step_scale_ = scale; }
  /// Quality::resolve_error_scale of the frames that follow.
  void set_resolve_error_scale(float scale) { resolve_error_scale_ = scale; }
  /// Quality::light_update_fraction of the frames that follow; below 1 they depend on those before.
  void set_light_update_fraction(float fraction) { light_update_fraction_ = fraction; }
  /// FrameInput::debug of the frames that follow.
  void set_view(passes::DebugView view, const std::optional<passes::ViewSlice>& slice) {
    debug_ = {view, slice};
  }
  /// GPU times of the passes of the last frame.
  std::vector<gpu::Timings::Scope> timings() const { return runner_.timings(); }
  /// Fraction of the pixels of the last frame whose rays were marched one by one, in [0, 1].
  double fraction_marched() const;
  /// How the last frame became colours.
  const image::Display& display() const { return display_; }
  /// Samples of each pixel in the last image.
  std::uint32_t samples() const { return samples_drawn_; }
  const scenario::Simulation& simulation() const { return *simulation_; }

 private:
  /// What to do with each sample of a frame: while it is recorded, and when it is drawn.
  struct EachSample {
    std::function<void(gpu::Recorder&, bool is_last)> read_back;
    std::function<void()> drawn = [] {};
    bool for_grading = false;  ///< For files that are graded later: rays end later.
  };
  void draw_frame(double seconds, std::uint32_t frame_index, const EachSample& each);

  gpu::Context& context_;
  const scenario::Scenario& scenario_;
  std::unique_ptr<scenario::Simulation> simulation_;
  gpu::CommandRunner runner_;
  render::Renderer renderer_;
  gpu::Buffer pixels_;
  std::optional<FrameLayers> layers_;  ///< From the first draw_layers on.
  gpu::Buffer list_;                   ///< shared::MarchList of the last frame.
  scenario::FrameOptions options_;
  std::optional<std::uint32_t> samples_;
  std::uint32_t samples_drawn_ = 0;
  image::Display display_;
  std::optional<float> exposure_;  ///< Instead of the timeline's; a factor.
  float step_scale_ = 1, light_update_fraction_ = 1, resolve_error_scale_ = 1;
  planning::DebugRequest debug_;
  std::optional<std::uint32_t> last_frame_index_;
};

}  // namespace brume::film
