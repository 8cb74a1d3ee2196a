// The user interface over the image: overlay, help, panels and time slider.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/viewer/figures.hpp"
#include "apps/viewer/player.hpp"
#include "apps/viewer/probe.hpp"
#include "apps/viewer/quality.hpp"
#include "apps/viewer/session.hpp"
#include "passes/debug_view.hpp"

namespace brume::viewer {

/// Settings that the player chooses by keys and panels.
struct Choices {
  bool panels = false, help = false, overlay = true;
  bool free_cursor = false;  ///< The mouse moves the cursor instead of turning the view.
  passes::DebugView view = passes::DebugView::none;
  std::optional<passes::ViewSlice> slice;  ///< Empty: through the middle of the smoke.
  Weapons weapons;
  Probe probe;
  std::optional<std::size_t> level;  ///< Index into quality_levels(); empty: adaptive.
  double frames_per_second = 60;
  bool temporal = true;  ///< Accumulates the smoke over frames.
  bool vertical_sync = true;
};

/// Requests from the panels and the time slider, applied after the layout.
struct UiRequests {
  std::optional<double> seek;  ///< [s]
  std::vector<Action> actions;
  bool play = false;             ///< Replay from the start.
  bool changed_picture = false;  ///< A paused image must be rendered again.
};

/// Messages and status for the overlay and the panels.
struct Notices {
  std::vector<std::string> lines;  ///< Recent messages, the newest last.
  std::string device;
  std::uint64_t device_bytes = 0;
  const Quality* quality = nullptr;
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
  UiRequests lay_out(Choices& choices, Session& session, Player& player, const Figures& figures,
                     const Notices& notices);
  /// Whether the panels currently capture the mouse or the keyboard.
  bool takes_mouse() const;
  bool takes_keys() const;
};

}  // namespace brume::viewer
