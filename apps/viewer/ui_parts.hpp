// The parts of Ui::lay_out.
#pragma once

#include "apps/viewer/ui.hpp"

namespace brume::viewer {

/// Frame statistics and recent messages.
void lay_out_overlay(const Choices& choices, const Session& session, const Player& player,
                     const Figures& figures, const Notices& notices);
/// All key bindings.
void lay_out_help();
/// The crosshair, the ends of the probe and its result.
void lay_out_marks(const Choices& choices, const Session& session, const Player& player);
/// The time slider with its buttons.
void lay_out_time_bar(Session& session, UiRequests& requests);
/// Settings and statistics.
void lay_out_panels(Choices& choices, Session& session, Player& player, const Figures& figures,
                    const Notices& notices, UiRequests& requests);

}  // namespace brume::viewer
