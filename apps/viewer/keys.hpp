// Key and mouse bindings: one table for input handling and for the help.
#pragma once

#include <cstddef>
#include <span>

namespace brume::viewer {

enum class Action {
  forward,
  back,
  left,
  right,
  up,
  down,
  throw_smoke,
  shoot,
  free_cursor,
  toggle_cursor,
  fly,
  shape_bullet,
  shape_glyph,
  shape_word,
  shape_picture,
  blast,
  door,
  probe,
  reset,
  pause,
  step_back,
  step_on,
  next_view,
  screenshot,
  save_recording,
  panels,
  overlay,
  full_screen,
  help,
  count,
};
constexpr std::size_t kActions = static_cast<std::size_t>(Action::count);

struct KeyBinding {
  Action action;
  bool mouse;  ///< Whether `code` is a GLFW mouse button; else a GLFW key.
  int code;
  const char* name;  ///< Label of the key.
  const char* does;  ///< Description in the help.
};

/// All bindings in the order of the help. An action may have several.
std::span<const KeyBinding> key_bindings();

}  // namespace brume::viewer
