// A window's pictures: a device, the renderer on it, and what Dear ImGui draws over. All of it may be lost
// and made again.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "apps/viewer/quality.hpp"
#include "apps/viewer/ui_pass.hpp"
#include "apps/viewer/window.hpp"
#include "image/image.hpp"
#include "render/renderer.hpp"
#include "scenario/scenario.hpp"

struct ImDrawData;

namespace brume::viewer {

struct ScreenOptions {
  std::string device;       ///< As gpu::choose_device takes it.
  bool validation = false;  ///< Validation layers; their messages are kept.
  bool vertical_sync = true;
};

class Screen {
 public:
  /// Frames that the device works on while the next is prepared: the last one only, so that what is shown is
  /// never older than one frame.
  static constexpr int kFramesInFlight = 1;

  /// The ImGui context is there. Window and scenario outlive the screen. Throws what Context and Renderer throw.
  Screen(const Window& window, const scenario::Scenario& scenario, const ScreenOptions& options);
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  /// Until the device is done with the last frame: comes before everything below. Throws gpu::DeviceLost.
  void wait();

  /// Draws `input` (null: the picture of the frame before stays) with `ui` over it, and shows them. False
  /// when the window shows nothing now.
  bool show(const render::FrameInput* input, const Quality& quality, const ImDrawData& ui);
  /// The same moment as `brume render` draws it, in a size of its own.
  image::Image8 picture(render::FrameInput input, glm::uvec2 size_px);

  void set_masks(const smoke::MaskAtlas& masks) { renderer_->set_masks(masks); }
  void set_vertical_sync(bool wanted) { swapchain_->set_vertical_sync(wanted); }
  bool vertical_sync() const { return swapchain_->vertical_sync(); }
  void lose_surface() { swapchain_->lose_surface(); }

  gpu::Context& context() { return context_; }
  /// GPU times of the last frame's passes.
  std::vector<gpu::Timings::Scope> timings() const { return runner_->timings(); }
  /// Processor time that the last frame took to prepare and to record [s].
  double record_seconds() const { return record_seconds_; }
  glm::uvec2 picture_px() const { return renderer_->size_px(); }

 private:
  void follow(glm::uvec2 picture_px, std::uint32_t march_scale);

  gpu::Context context_;
  std::optional<gpu::CommandRunner> runner_;
  std::optional<gpu::Swapchain> swapchain_;
  std::optional<render::Renderer> renderer_;
  std::optional<UiPass> ui_;
  gpu::Image canvas_;              ///< As large as the window: the picture, and what is drawn over it.
  std::uint32_t march_scale_ = 1;  ///< Of the renderer.
  bool is_fresh_ = false;          ///< No frame to go on from.
  double record_seconds_ = 0;
};

}  // namespace brume::viewer
