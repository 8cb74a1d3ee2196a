// What is drawn over the picture: the line of figures, the help, the panels, the bar of time.
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

/// What the person has chosen. The panels change it.
struct Choices {
  bool panels = false, help = false, overlay = true;
  bool free_cursor = false;  ///< The mouse moves the cursor instead of the view.
  passes::DebugView view = passes::DebugView::none;
  std::optional<passes::ViewSlice> slice;  ///< Empty: through the middle of the smoke.
  Weapons weapons;
  Probe probe;
  std::optional<std::size_t> level;  ///< Of quality_levels; empty: as the frame rate allows.
  double frames_per_second = 60;
  bool gather = true;  ///< Smoke over the frames.
  bool vertical_sync = true;
};

/// What the panels and the bar of time ask for.
struct UiRequests {
  std::optional<double> seek;  ///< [s]
  std::vector<Action> actions;
  bool play = false;             ///< From the beginning.
  bool changed_picture = false;  ///< Something that a still picture shows.
};

/// What is told.
struct Notices {
  std::vector<std::string> lines;  ///< The last ones that were said, the newest last.
  std::string device;
  std::uint64_t device_bytes = 0;
  const Quality* quality = nullptr;
  glm::uvec2 picture_px{0};
  std::string shader_errors;  ///< Empty: none.
};

/// Dear ImGui with our font and colours, for a window.
class Ui {
 public:
  explicit Ui(const Window& window);
  ~Ui();
  Ui(const Ui&) = delete;
  Ui& operator=(const Ui&) = delete;

  void begin_frame();
  /// Lays everything out; what is to be drawn is in ImGui::GetDrawData() until the next frame begins.
  UiRequests lay_out(Choices& choices, Session& session, Player& player, const Figures& figures,
                 const Notices& notices);
  /// Whether the mouse or the keyboard are the panels' now.
  bool takes_mouse() const;
  bool takes_keys() const;
};

}  // namespace brume::viewer
