// What a person can do at the keyboard and the mouse: one table, from which the window reads and the help is
// made.
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
  let_cursor_go,
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
  bool mouse;  ///< `code` is a button of the mouse, else a key; both as GLFW numbers them.
  int code;
  const char* name;  ///< As it is printed on the key.
  const char* does;
};

/// In the order of the help. An action may have more than one key.
std::span<const KeyBinding> key_bindings();

}  // namespace brume::viewer
