// A window of the desktop, and what the keyboard and the mouse do to it.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "apps/viewer/keys.hpp"
#include "gpu/swapchain.hpp"

struct GLFWwindow;

namespace brume::viewer {

/// What happened since the last time it was asked, and what is held down.
struct Input {
  std::vector<Action> pressed;  ///< In the order in which it came.
  std::array<bool, kActions> held{};
  glm::dvec2 look_px{0};  ///< How far the mouse moved while the window held it.
  double wheel = 0;       ///< Notches, away from the user.
  bool is_held(Action action) const { return held[static_cast<std::size_t>(action)]; }
};

class Window {
 public:
  /// Throws no_device when there is no display.
  Window(glm::uvec2 size_px, const std::string& title);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  GLFWwindow* handle() const { return handle_; }
  /// What a gpu::Context needs to show pictures here, and the surface that they are shown on.
  gpu::Presentation presentation() const;
  gpu::SurfaceMaker surface() const;

  glm::uvec2 size_px() const;
  bool should_close() const;
  /// Takes in what happened. With `wait_seconds` > 0 it sleeps until something does, at most so long.
  void poll(double wait_seconds);
  Input take_input();
  /// Whether the mouse turns the view instead of moving the cursor.
  void hold_mouse(bool hold);
  bool holds_mouse() const { return holds_mouse_; }
  /// Of the cursor while it is free [px].
  glm::vec2 cursor_px() const;
  /// The screen that it is on as a whole, or the window as it was before.
  void toggle_full_screen();

 private:
  static void on_key(GLFWwindow* window, int key, int scancode, int change, int modifiers);
  static void on_button(GLFWwindow* window, int button, int change, int modifiers);
  static void on_cursor(GLFWwindow* window, double x, double y);
  static void on_wheel(GLFWwindow* window, double x, double y);
  static void on_focus(GLFWwindow* window, int focused);
  void change(bool mouse, int code, bool pressed);

  GLFWwindow* handle_ = nullptr;
  Input input_;
  bool holds_mouse_ = false;
  bool knows_cursor_ = false;  ///< last_cursor_ is of the same mode of the cursor.
  glm::dvec2 last_cursor_{0};
  glm::ivec4 windowed_{0};  ///< Place and size before it took the whole screen.
};

}  // namespace brume::viewer
