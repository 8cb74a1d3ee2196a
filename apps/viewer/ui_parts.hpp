// The parts of Ui::lay_out.
#pragma once

#include <imgui.h>

#include "apps/viewer/document.hpp"
#include "apps/viewer/game.hpp"
#include "apps/viewer/quality.hpp"

namespace brume::viewer {

constexpr float kTimeBarHeight = 64;  // [px]
constexpr float kMargin = 8;          // [px], around windows
const ImVec4 kAccentText(1, 0.8f, 0.5f, 1), kFaultText(1, 0.45f, 0.4f, 1),
    kChangedText(0.98f, 0.74f, 0.40f, 1);
/// Width of the settings at the right side [px].
float panel_width();

/// Where a world point is on the display; nothing if it is behind the near plane.
std::optional<glm::vec2> on_display(const scene::Camera& camera, glm::vec3 world);

// What all documents have.

/// The status of a document, and recent messages.
void lay_out_overlay(Document& document, const Status& status);
/// All settings of a document.
void lay_out_panels(Document& document, const Status& status, UiRequests& requests);
/// The time slider with its buttons.
void lay_out_time_bar(Document& document, UiRequests& requests);
/// A button of that bar. Returns whether it was clicked.
bool bar_button(const char* label, const char* tooltip);
/// Work in the background; whether it shall stop.
bool lay_out_work(const Work& work);
/// All key bindings of a map, and a line below them.
void lay_out_help(KeyMap map, const char* note);
/// How much of some work is done, as wide as its window and so high [px].
void lay_out_progress(double fraction, float height);
/// "65,535"
std::string grouped(std::uint64_t number);

// What levels have.

/// What a paused window shows.
enum class Refinement { none, drawing, done };

/// What overlay and panels of a level say besides.
struct Notices {
  const Quality& quality;
  bool automatic;  ///< The quality is adaptive.
  Refinement refinement;
  double pace;  ///< Session time per real time.
  glm::uvec2 picture_px;
};

void lay_out_level_status(const Game& game, const Figures& figures, const Notices& notices);
/// The crosshair, the ends of the probe and its result.
void lay_out_level_marks(const Game& game);
void lay_out_level_sections(Game& game, const Figures& figures, const Notices& notices, const Status& status,
                            UiRequests& requests);
void lay_out_level_buttons(const Session& session, UiRequests& requests);
/// The events of a timeline, and the keys of its carriers.
void mark_events(const scene::Timeline& timeline, const TimeMark& mark);
/// What was shot and blown up just now: flashes, tracers and impacts.
void lay_out_shot_marks(const Game& game);
/// Look, masks, disturbances and transfer functions of the volumes.
void lay_out_volumes(Game& game);
/// How the decals darken, and whether they are shown.
void lay_out_decals(Game& game);
/// The carriers and their keys, and steering one.
void lay_out_carriers(Game& game, UiRequests& requests);
/// Times, memory and the state of the simulation.
void lay_out_figures(const Session& session, const Figures& figures, const Status& status);

}  // namespace brume::viewer
