// The parts of the Ui, one function each.
#pragma once

#include "apps/viewer/ui.hpp"

namespace brume::viewer {

/// The line of figures, and below it what was said last.
void lay_out_overlay(const Choices& choices, const Session& session, const Player& player,
                     const Figures& figures, const Notices& notices);
/// Every key, from key_bindings.
void lay_out_help();
/// The cross in the middle, the probe's ends and what it sees.
void lay_out_marks(const Choices& choices, const Session& session, const Player& player);
/// The bar of time.
void lay_out_time_bar(Session& session, UiRequests& requests);
/// Settings and figures.
void lay_out_panels(Choices& choices, Session& session, Player& player, const Figures& figures,
                    const Notices& notices, UiRequests& requests);

}  // namespace brume::viewer
