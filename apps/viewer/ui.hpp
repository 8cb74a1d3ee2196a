// The user interface over the image: overlay, help, panels and time slider.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/viewer/figures.hpp"
#include "apps/viewer/game.hpp"
#include "apps/viewer/quality.hpp"
#include "apps/viewer/widgets.hpp"

namespace brume::viewer {

/// Requests from the panels and the time slider, applied after the layout.
struct UiRequests {
  std::optional<double> seek;  ///< [s]
  std::vector<Action> actions;
  bool play = false;  ///< Replay from the start along the camera path.
};

/// What a paused window shows.
enum class Refinement { none, drawing, done };

/// Messages and status for the overlay and the panels.
struct Notices {
  std::vector<std::string> lines;  ///< Recent messages, the newest last.
  std::string device;
  std::uint64_t device_bytes = 0;
  const Quality* quality = nullptr;
  bool automatic = true;  ///< The quality is adaptive.
  Refinement refinement = Refinement::none;
  double pace = 1;  ///< Session time per real time.
  glm::uvec2 picture_px{0};
  std::string shader_errors;  ///< Empty: none.
};

/// Dear ImGui for a window, with the project's font and colours.
class Ui {
 public:
  explicit Ui(const Window& window);
  ~Ui();
  Ui(const Ui&) = delete;
  Ui& operator=(const Ui&) = delete;

  void begin_frame();
  /// Lays out everything; ImGui::GetDrawData() holds the result until the next frame begins.
  UiRequests lay_out(Game& game, const Figures& figures, const Notices& notices);
  /// The same while a level loads: its name, and the work that goes on.
  void lay_out_loading(const std::string& level, const std::string& work, double seconds);
  /// Whether the panels currently capture the mouse or the keyboard.
  bool takes_mouse() const;
  bool takes_keys() const;
  /// Whether a popup or a list is open.
  bool has_popup() const;
  /// Whether a widget is held or edited.
  bool is_editing() const;
  const std::vector<Widget>& widgets() const { return widgets_.widgets(); }

 private:
  WidgetLog widgets_;
};

}  // namespace brume::viewer
