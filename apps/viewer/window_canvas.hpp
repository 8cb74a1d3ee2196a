// What every screen of a window has: its swapchain, and a canvas for a picture with the user interface over
// it.
#pragma once

#include <functional>
#include <optional>

#include "apps/viewer/ui_pass.hpp"
#include "apps/viewer/upscale_pass.hpp"
#include "apps/viewer/window.hpp"

namespace brume::viewer {

class WindowCanvas {
 public:
  /// Requires an ImGui context. Context, runner and window must outlive it. Throws what gpu::Swapchain
  /// throws.
  WindowCanvas(gpu::Context& context, gpu::CommandRunner& runner, const Window& window, bool vertical_sync);

  /// Begins a frame: its size [px], or nothing while the window shows nothing, for example because it is
  /// minimized. The device must have completed the previous frame.
  std::optional<glm::uvec2> begin();
  /// Submits what `record` records, then `picture` (null: black) enlarged to the window, and `ui` over it.
  /// After begin().
  void submit(const std::function<void(gpu::Recorder&)>& record, const gpu::Image* picture,
              const ImDrawData& ui);
  /// Shows what was submitted; may wait for the display.
  void present() { swapchain_.present(); }

  void set_vertical_sync(bool enabled) { swapchain_.set_vertical_sync(enabled); }
  bool vertical_sync() const { return swapchain_.vertical_sync(); }
  void lose_surface() { swapchain_.lose_surface(); }
  glm::uvec2 size_px() const { return glm::uvec2(canvas_.info().size); }

 private:
  gpu::Context& context_;
  gpu::CommandRunner& runner_;
  gpu::Swapchain swapchain_;
  UiPass ui_;
  UpscalePass upscale_;
  gpu::Image canvas_;  ///< Window-sized: the scaled picture with the user interface over it.
  gpu::Recorder::WindowImage image_;
};

}  // namespace brume::viewer
