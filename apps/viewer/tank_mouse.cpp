#include "apps/viewer/tank_mouse.hpp"

#include <algorithm>

namespace brume::viewer {

void TankMouse::begin(TankChoices& choices, Action action) {
  if (action == Action::pan) {
    drag_ = Drag::pan;
  } else {
    drag_ = hovered_ ? Drag::handle : Drag::orbit;
    choices.selected = hovered_;
  }
}

void TankMouse::update(TankState& state, TankChoices& choices, const Input& input, glm::vec2 cursor,
                       glm::vec2 size, bool has_cursor) {
  // What is dragged may be gone by an undo.
  const auto handles = handles_of(state.scene());
  if (drag_ == Drag::handle && std::ranges::find(handles, *choices.selected) == handles.end()) drag_.reset();
  if (drag_) {
    const glm::vec2 drag = (cursor - last_cursor_) / std::max(size.y, 1.0f);
    const scene::Camera camera = state.camera();
    const bool moves = drag != glm::vec2(0);
    if (*drag_ == Drag::orbit && moves) state.move_camera(orbited(camera, drag));
    if (*drag_ == Drag::pan && moves) state.move_camera(panned(camera, drag));
    if (*drag_ == Drag::handle && moves) {
      const glm::vec3 place = place_of(state.scene(), *choices.selected, state.seconds());
      move_handle(state.edit(), *choices.selected, state.seconds(), dragged(camera, drag, place));
    }
    if (!input.is_held(*drag_ == Drag::pan ? Action::pan : Action::orbit)) drag_.reset();
  }
  last_cursor_ = cursor;
  if (!drag_) {
    hovered_.reset();
    if (has_cursor && choices.overlay)
      hovered_ = handle_at(state.scene(), state.seconds(), state.camera(), size, cursor, kReach);
    for (const Action action : input.pressed)
      if (action == Action::orbit || action == Action::pan) begin(choices, action);
    // A click that ended within the frame.
    if (drag_ && !input.is_held(*drag_ == Drag::pan ? Action::pan : Action::orbit)) drag_.reset();
  }
  if (input.wheel != 0) state.move_camera(zoomed(state.camera(), input.wheel));
}

}  // namespace brume::viewer
