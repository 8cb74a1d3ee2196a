// All GPU state of a window: device, swapchain, renderer and user interface. Recreated as a whole after a
// device loss.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "apps/viewer/game_frame.hpp"
#include "apps/viewer/quality.hpp"
#include "apps/viewer/screen_options.hpp"
#include "apps/viewer/window_canvas.hpp"
#include "image/image.hpp"
#include "render/renderer.hpp"
#include "scenario/scenario.hpp"

struct ImDrawData;

namespace brume::viewer {

class Screen {
 public:
  /// Requires an ImGui context. The window must outlive the screen. Throws what Context throws.
  Screen(const Window& window, const ScreenOptions& options);
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  /// Makes the renderer of a scenario, which must outlive it, and reduces its volumes to what the device has
  /// room for: at most `volume_bytes` (0: no such limit). May run in another thread while no other member is
  /// called. Throws what Renderer throws.
  void load(const scenario::Scenario& scenario, glm::uvec2 size_px, std::uint64_t volume_bytes = 0);

  /// Waits until the device has finished the last frame: required before every call below. Throws
  /// gpu::DeviceLost.
  void wait();

  /// Renders `input` (null: repeats the previous image; black before load()), draws `ui` over it and
  /// presents. Returns false if the window currently shows nothing, for example because it is minimized.
  bool show(const render::FrameInput* input, const Quality& quality, const ImDrawData& ui);
  /// Renders `input` at full quality in parts, to be shown next, and returns true; false as soon as `stops`
  /// returns true between two parts: then the next frame must be rendered.
  bool refine(render::FrameInput input, const std::function<bool()>& stops);
  /// The exposure factor that fits `input` (render::measure_exposure).
  float measure_exposure(const render::FrameInput& input);
  /// Renders samples of a frame as `brume render` does, at full quality and the given size.
  image::Image8 picture(const StillFrame& frame, glm::uvec2 size_px);

  /// Whether volumes of the last frame have bricks that are still to be uploaded.
  bool streams_volumes() const { return renderer_ && renderer_->streams_volumes(); }

  void set_masks(const smoke::MaskAtlas& masks) { renderer_->set_masks(masks); }
  void set_vertical_sync(bool enabled) { canvas_->set_vertical_sync(enabled); }
  bool vertical_sync() const { return canvas_->vertical_sync(); }
  void lose_surface() { canvas_->lose_surface(); }

  gpu::Context& context() { return context_; }
  /// GPU times of the passes of the last frame.
  std::vector<gpu::Timings::Scope> timings() const { return runner_->timings(); }
  /// CPU time to prepare and record the last frame [s].
  double record_seconds() const { return record_seconds_; }
  glm::uvec2 picture_px() const { return renderer_ ? renderer_->targets().size_px : glm::uvec2(0); }

 private:
  void set_resolution(glm::uvec2 picture_px, std::uint32_t march_scale);
  void begin_still(render::FrameInput& input, glm::uvec2 size_px);

  gpu::Context context_;
  std::optional<gpu::CommandRunner> runner_;
  std::optional<WindowCanvas> canvas_;
  std::optional<render::Renderer> renderer_;
  std::uint32_t march_scale_ = 1;  ///< Current one of the renderer.
  bool history_lost_ = false;      ///< The renderer has no previous frame to accumulate with.
  double record_seconds_ = 0;
};

}  // namespace brume::viewer
