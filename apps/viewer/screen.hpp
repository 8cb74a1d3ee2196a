// The GPU state of a window, whatever it shows: device, swapchain, and a canvas for a picture with the user
// interface over it. Recreated as a whole after a device loss.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "apps/viewer/ui_pass.hpp"
#include "apps/viewer/upscale_pass.hpp"
#include "apps/viewer/window.hpp"
#include "image/image.hpp"

namespace brume::viewer {

struct ScreenOptions {
  std::string device;       ///< As for gpu::choose_device.
  bool validation = false;  ///< Enables the validation layers; Context stores their messages.
  bool vertical_sync = true;
};

class Screen {
 public:
  /// Requires an ImGui context. The window must outlive the screen. Throws what gpu::Context and
  /// gpu::Swapchain throw.
  Screen(const Window& window, const ScreenOptions& options);
  ~Screen() { finish(); }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  /// Waits until the device has finished the last frame: required before every call below. Throws
  /// gpu::DeviceLost.
  void wait() { context_.wait(); }
  /// Waits before something on the device is destroyed. A lost device is at rest.
  void finish() { context_.vk().DeviceWaitIdle(context_.device()); }

  /// Begins a frame: its size [px], or nothing while the window shows nothing, for example because it is
  /// minimized.
  std::optional<glm::uvec2> begin();
  /// After begin(): submits what `record` records, then `picture` (null: black) enlarged to the window and
  /// `ui` over it, and presents them; may wait for the display.
  void show(const std::function<void(gpu::Recorder&)>& record, const gpu::Image* picture,
            const ImDrawData& ui);
  /// The pixels of an image of 8 bits.
  image::Image8 read(const gpu::Image& image);

  gpu::Context& context() { return context_; }
  gpu::CommandRunner& runner() { return runner_; }
  glm::uvec2 size_px() const { return glm::uvec2(canvas_.info().size); }
  /// GPU times of the passes of the last frame.
  std::vector<gpu::Timings::Scope> timings() const { return runner_.timings(); }
  /// CPU time to record the last frame [s].
  double record_seconds() const { return record_seconds_; }

  void set_vertical_sync(bool enabled) { swapchain_.set_vertical_sync(enabled); }
  void lose_surface() { swapchain_.lose_surface(); }

 private:
  gpu::Context context_;
  gpu::CommandRunner runner_;
  gpu::Swapchain swapchain_;
  UiPass ui_;
  UpscalePass upscale_;
  gpu::Image canvas_;  ///< Window-sized: the scaled picture with the user interface over it.
  gpu::Recorder::WindowImage image_;
  double record_seconds_ = 0;
};

}  // namespace brume::viewer
