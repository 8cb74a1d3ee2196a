// A window's swapchain images: acquisition and presentation.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "gpu/recorder.hpp"

namespace brume::gpu {

/// The window of a swapchain.
struct SurfaceMaker {
  /// Creates a surface of the window. Throws Error on failure.
  std::function<VkSurfaceKHR(VkInstance)> make;
  /// Its current size [px]; a side of 0: it cannot be presented to.
  std::function<glm::uvec2()> size_px;
};

class Swapchain {
 public:
  /// `context` must have been created with a Presentation and must outlive the swapchain. Throws no_device
  /// when the window does not support 8 bits per channel.
  Swapchain(Context& context, SurfaceMaker window, bool vertical_sync);
  ~Swapchain();
  Swapchain(const Swapchain&) = delete;
  Swapchain& operator=(const Swapchain&) = delete;

  /// The next image to render into; recreates the swapchain if the window was resized or the surface was
  /// lost. Empty while nothing can be presented, as for a minimized window. The device must have completed
  /// the previous frame.
  std::optional<Recorder::WindowImage> acquire();
  /// The semaphores for the submission that writes the acquired image.
  WindowSemaphores semaphores() const;
  /// Presents the acquired image after that submission.
  void present();

  void set_vertical_sync(bool wanted);
  bool vertical_sync() const { return vertical_sync_; }
  /// Treats the surface as lost, as a window system may do at any time.
  void lose_surface() { surface_lost_ = true; }

 private:
  bool make();
  void get_images();
  void destroy();
  VkPresentModeKHR choose_mode() const;

  Context& context_;
  SurfaceMaker window_;
  VkSurfaceKHR surface_ = VK_NULL_HANDLE;
  VkSwapchainKHR handle_ = VK_NULL_HANDLE;
  glm::uvec2 size_px_{0};
  std::vector<VkImage> images_;
  VkSemaphore acquired_ = VK_NULL_HANDLE;
  std::vector<VkSemaphore> drawn_;  ///< One per image.
  std::uint32_t index_ = 0;         ///< Index of the acquired image.
  bool vertical_sync_ = true, out_of_date_ = true, surface_lost_ = false;
};

}  // namespace brume::gpu
