// The parts of Ui::lay_out.
#pragma once

#include "apps/viewer/ui.hpp"

namespace brume::viewer {

constexpr float kTimeBarHeight = 64;  // [px]
constexpr float kMargin = 8;          // [px], around windows
/// Width of the settings at the right side [px].
float panel_width();

/// Where a world point is on the display; nothing if it is behind the near plane.
std::optional<glm::vec2> on_display(const scene::Camera& camera, glm::vec3 world);

/// Status and recent messages.
void lay_out_overlay(const Game& game, const Figures& figures, const Notices& notices);
/// All key bindings of a map, and a line below them.
void lay_out_help(KeyMap map, const char* note);
/// The crosshair, the ends of the probe and its result.
void lay_out_marks(const Game& game);
/// What was shot and blown up just now: flashes, tracers and impacts.
void lay_out_shot_marks(const Game& game);
/// The time slider with its buttons.
void lay_out_time_bar(const Session& session, UiRequests& requests);
/// All settings.
void lay_out_panels(Game& game, const Figures& figures, const Notices& notices, UiRequests& requests);
/// Look, masks, disturbances and transfer functions of the volumes.
void lay_out_volumes(Game& game);
/// How the decals darken, and whether they are shown.
void lay_out_decals(Game& game);
/// The carriers and their keys, and steering one.
void lay_out_carriers(Game& game, UiRequests& requests);
/// Times, memory and the state of the simulation.
void lay_out_figures(const Session& session, const Figures& figures, const Notices& notices);

}  // namespace brume::viewer
