// All GPU state of a window that shows a tank. Recreated as a whole after a device loss.
#pragma once

#include <optional>

#include "apps/viewer/screen_options.hpp"
#include "apps/viewer/tank_schedule.hpp"
#include "apps/viewer/window_canvas.hpp"
#include "image/image.hpp"
#include "render/tank_renderer.hpp"

namespace brume::viewer {

class TankScreen {
 public:
  /// Requires an ImGui context. The window must outlive the screen. Throws what Context throws.
  TankScreen(const Window& window, const ScreenOptions& options);
  ~TankScreen();
  TankScreen(const TankScreen&) = delete;
  TankScreen& operator=(const TankScreen&) = delete;

  /// Uploads a tank in the place of the one before, if any. May run in another thread while no other member
  /// is called. Throws what TankRenderer throws; then there is none.
  void load(const spheres::Tank& tank, glm::uvec2 size_px);
  bool is_loaded() const { return renderer_.has_value(); }

  /// Waits until the device has finished the last frame: required before every call below. Throws
  /// gpu::DeviceLost.
  void wait() { context_.wait(); }

  /// What samples from the next one on show, in a picture of the size of the plan. Throws what
  /// TankRenderer::set_kind throws.
  void set_view(const planning::TankPlan& plan, const planning::TankDisplay& display, scene::TankView kind,
                scene::TankLighting lighting);
  /// As TankRenderer::set_photons.
  void set_photons(const spheres::LightPaths& paths) { renderer_->set_photons(paths); }
  /// As TankRenderer::replace_photons.
  void replace_photons(const spheres::LightPaths& paths) { renderer_->replace_photons(paths); }
  /// Exposure, tone curve and dither alone.
  void set_display(const planning::TankDisplay& display);

  /// Begins a frame, as WindowCanvas::begin.
  std::optional<glm::uvec2> begin() { return canvas_->begin(); }
  /// Adds a slice, draws `ui` over the newest complete picture (black before the first) and presents. After
  /// begin().
  void show(const TankSlice& slice, const ImDrawData& ui);
  /// Adds a slice alone, and waits for it.
  void add(const TankSlice& slice);
  /// The picture so far. After the first sample of each pixel.
  image::Image8 picture();

  /// Of the picture that is drawn.
  glm::uvec2 picture_px() const;
  std::uint32_t samples() const { return renderer_ ? renderer_->samples() : 0; }
  std::uint32_t rows() const { return renderer_ ? renderer_->rows() : 0; }
  /// What the device took for the last slice [s], and for all that it did.
  double slice_seconds() const;
  std::vector<gpu::Timings::Scope> timings() const { return runner_->timings(); }

  void set_vertical_sync(bool enabled) { canvas_->set_vertical_sync(enabled); }
  void lose_surface() { canvas_->lose_surface(); }
  gpu::Context& context() { return context_; }

 private:
  void record(gpu::Recorder& recorder, const TankSlice& slice);

  gpu::Context context_;
  std::optional<gpu::CommandRunner> runner_;
  std::optional<WindowCanvas> canvas_;
  std::optional<render::TankRenderer> renderer_;
  std::optional<scene::TankView> kind_;  ///< Of the renderer; none after a failure.
  scene::TankLighting lighting_ = scene::TankLighting::maps;
  gpu::Image shown_;              ///< The newest complete picture; none before the first.
  bool display_changed_ = false;  ///< The picture so far has another exposure than it shall have.
};

}  // namespace brume::viewer
