// What the mouse drags in the picture of a tank: the camera, or a mark.
#pragma once

#include <optional>

#include "apps/viewer/tank_state.hpp"
#include "apps/viewer/tank_ui.hpp"
#include "apps/viewer/window.hpp"

namespace brume::viewer {

class TankMouse {
 public:
  static constexpr float kReach = 12;  ///< How near to a mark the cursor hovers it [px].

  /// Moves what the mouse drags, now that the cursor is there in a window of this size [px]. `has_cursor`: it
  /// is not over the panels. Presses on a panel must not be in `input`.
  void update(TankState& state, TankChoices& choices, const Input& input, glm::vec2 cursor, glm::vec2 size,
              bool has_cursor);
  bool is_dragging() const { return drag_.has_value(); }
  /// What a press would drag.
  const std::optional<TankHandle>& hovered() const { return hovered_; }

 private:
  enum class Drag { orbit, pan, handle };
  void begin(TankChoices& choices, Action action);

  std::optional<Drag> drag_;
  std::optional<TankHandle> hovered_;
  glm::vec2 last_cursor_{0};
};

}  // namespace brume::viewer
