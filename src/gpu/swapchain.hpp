// The images of a window, and the way of a picture into one of them.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "gpu/recorder.hpp"

namespace brume::gpu {

/// A window as a swapchain sees it.
struct SurfaceMaker {
  /// A new surface of the window. Throws Error when there is none.
  std::function<VkSurfaceKHR(VkInstance)> make;
  /// Its size now [px]; a side of 0: nothing can be shown.
  std::function<glm::uvec2()> size_px;
};

class Swapchain {
 public:
  /// `context` was made with a Presentation, and outlives it. Throws no_device when the window takes no
  /// pictures of 8 bits a channel.
  Swapchain(Context& context, SurfaceMaker window, bool vertical_sync);
  ~Swapchain();
  Swapchain(const Swapchain&) = delete;
  Swapchain& operator=(const Swapchain&) = delete;

  /// The window's image to draw into next, made anew for a window that was resized and for a surface that was
  /// lost. Empty while nothing can be shown: a minimized window. When the device is done with the frame
  /// before.
  std::optional<Recorder::WindowImage> acquire();
  /// For the submission of what writes the acquired image.
  WindowSemaphores semaphores() const;
  /// Shows the acquired image after that submission.
  void present();

  void set_vertical_sync(bool wanted);
  bool vertical_sync() const { return vertical_sync_; }
  /// Treats the surface as lost, as a window system may do at any time.
  void lose_surface() { surface_lost_ = true; }

 private:
  bool make();
  void destroy();
  VkPresentModeKHR choose_mode() const;

  Context& context_;
  SurfaceMaker window_;
  VkSurfaceKHR surface_ = VK_NULL_HANDLE;
  VkSwapchainKHR handle_ = VK_NULL_HANDLE;
  glm::uvec2 size_px_{0};
  std::vector<VkImage> images_;
  VkSemaphore acquired_ = VK_NULL_HANDLE;
  std::vector<VkSemaphore> drawn_;  ///< Of each image.
  std::uint32_t index_ = 0;         ///< Of the acquired image.
  bool vertical_sync_ = true, out_of_date_ = true, surface_lost_ = false;
};

}  // namespace brume::gpu
