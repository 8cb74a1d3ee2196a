// Plays a stage on a device: draws any moment of its timeline.
#pragma once

#include <memory>
#include <optional>

#include "image/image.hpp"
#include "render/renderer.hpp"
#include "stage/simulation.hpp"

namespace brume::render {

/// What a renderer shows of a stage at a time. `holes` keeps the holes that the result refers to.
FrameInput frame_input(const stage::Stage& stage, const stage::Simulation& simulation, double seconds,
                       std::vector<shared::Hole>& holes);

/// A stage on a device, frame after frame.
class Playback {
 public:
  /// `stage` must outlive it. Throws what Renderer and Simulation::create throw.
  Playback(gpu::Context& context, const stage::Stage& stage, const RendererOptions& options);
  Playback(gpu::Context& context, const stage::Stage& stage, glm::uvec2 size_px)
      : Playback(context, stage, RendererOptions{size_px}) {}

  /// The picture at a time [s]: the same for the same time and frame index, whatever came before. With
  /// RendererOptions::temporal a frame whose index is one more than that of the draw before goes on from it;
  /// any other begins anew.
  image::Image8 draw(double seconds, std::uint32_t frame_index);
  /// Where the camera is instead of on the timeline's path; empty: on the path.
  void set_camera(const std::optional<scene::Camera>& camera) { camera_ = camera; }
  /// FrameInput::step_scale of the frames that follow.
  void set_step_scale(float scale) { step_scale_ = scale; }
  /// FrameInput::seen_scale of the frames that follow.
  void set_seen_scale(float scale) { seen_scale_ = scale; }
  /// FrameInput::light_share of the frames that follow; below 1 they depend on those before.
  void set_light_share(float share) { light_share_ = share; }
  /// FrameInput::view and view_slice from now on.
  void set_view(passes::DebugView view, const std::optional<passes::ViewSlice>& slice) {
    view_ = view;
    slice_ = slice;
  }
  /// GPU times of the passes of the last frame.
  std::vector<gpu::Timings::Scope> timings() const { return runner_.timings(); }
  /// Share of the pixels of the last frame whose rays were marched one by one, in [0, 1].
  double share_marched() const;
  const stage::Simulation& simulation() const { return *simulation_; }

 private:
  const stage::Stage& stage_;
  std::unique_ptr<stage::Simulation> simulation_;
  gpu::CommandRunner runner_;
  Renderer renderer_;
  gpu::Buffer pixels_;
  gpu::Buffer list_;  ///< shared::MarchList of the last frame.
  std::optional<scene::Camera> camera_;
  float step_scale_ = 1, light_share_ = 1, seen_scale_ = 1;
  passes::DebugView view_ = passes::DebugView::none;
  std::optional<passes::ViewSlice> slice_;
  std::optional<std::uint32_t> last_frame_index_;
};

}  // namespace brume::render
