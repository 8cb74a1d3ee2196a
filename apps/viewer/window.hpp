// A desktop window with keyboard and mouse input.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "apps/viewer/keys.hpp"
#include "gpu/swapchain.hpp"

struct GLFWwindow;

namespace brume::viewer {

/// Input events since the last call of take_input(), and the actions whose keys are held down.
struct Input {
  std::vector<Action> pressed;  ///< In order of arrival.
  std::array<bool, kActions> held{};
  glm::dvec2 look_px{0};                       ///< Mouse motion while the window captured it.
  double wheel = 0;                            ///< Notches; positive: away from the user.
  std::vector<std::filesystem::path> dropped;  ///< Files dragged into the window.
  bool is_held(Action action) const { return held[static_cast<std::size_t>(action)]; }
};

class Window {
 public:
  /// Throws no_device without a display.
  Window(glm::uvec2 size_px, const std::string& title, KeyMap keys = KeyMap::level);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  GLFWwindow* handle() const { return handle_; }
  /// What gpu::Context and gpu::Swapchain need to present to this window.
  gpu::Presentation presentation() const;
  gpu::SurfaceMaker surface() const;

  glm::uvec2 size_px() const;
  bool should_close() const;
  /// Processes pending events. With `wait_seconds` > 0 sleeps until an event arrives, but no longer than
  /// that.
  void poll(double wait_seconds);
  /// Returns the input since the last call and clears its events.
  Input take_input();
  /// Number of input events so far: keys, buttons, wheel and motion.
  std::uint64_t events() const { return events_; }
  /// Captures the mouse to turn the view, or releases it to move the cursor.
  void capture_mouse(bool capture);
  bool captures_mouse() const { return captures_mouse_; }
  /// Position of the free cursor [px].
  glm::vec2 cursor_px() const;
  /// Switches between full screen and the previous window.
  void toggle_full_screen();

 private:
  static void on_key(GLFWwindow* window, int key, int scancode, int change, int modifiers);
  static void on_button(GLFWwindow* window, int button, int change, int modifiers);
  static void on_cursor(GLFWwindow* window, double x, double y);
  static void on_wheel(GLFWwindow* window, double x, double y);
  static void on_focus(GLFWwindow* window, int focused);
  static void on_size(GLFWwindow* window, int width, int height);
  static void on_drop(GLFWwindow* window, int count, const char** paths);
  void change(bool mouse, int code, bool pressed, int modifiers);

  GLFWwindow* handle_ = nullptr;
  KeyMap keys_;
  Input input_;
  std::uint64_t events_ = 0;
  bool captures_mouse_ = false;
  bool cursor_known_ = false;  ///< last_cursor_ was set since the mouse was captured or released.
  glm::dvec2 last_cursor_{0};
  glm::ivec4 windowed_{0};  ///< Position and size before full screen.
};

}  // namespace brume::viewer
