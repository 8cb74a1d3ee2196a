// What the user chooses in every window.
#pragma once

#include "apps/viewer/keys.hpp"

namespace brume::viewer {

struct WindowChoices {
  bool panels = false, help = false, overlay = true;
  bool vertical_sync = true;

  /// Shows or hides panels and overlay by their keys.
  void act(Action action) {
    if (action == Action::panels) panels = !panels;
    if (action == Action::overlay) overlay = !overlay;
  }
};

}  // namespace brume::viewer
