// Key and mouse bindings: one table for input handling, the help and the documentation.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

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
  steer_carrier,
  add_key,
  shape_bullet,
  shape_glyph,
  shape_word,
  shape_picture,
  blast,
  door,
  probe,
  rewind,
  empty,
  undo,
  redo,
  pause,
  step_back,
  step_on,
  next_view,
  decals,
  screenshot,
  save_recording,
  orbit,
  pan,
  camera_path,
  home,
  focus,
  save_tank,
  panels,
  overlay,
  full_screen,
  help,
  close_popup,
  count,
};
constexpr std::size_t kActions = static_cast<std::size_t>(Action::count);

/// What the keys control.
enum class KeyMap { level, tank };

enum class KeyGroup { move, act, time, view, files, count };
const char* name_of(KeyGroup group);

/// Modifier keys that are held.
struct Modifiers {
  bool shift = false, control = false;
  bool operator==(const Modifiers&) const = default;
};

struct KeyBinding {
  Action action;
  KeyGroup group;
  bool mouse;  ///< Whether `code` is a GLFW mouse button; else a GLFW key.
  int code;
  const char* name;  ///< Label of the key, modifiers included.
  const char* does;  ///< Description in the help.
  Modifiers modifiers = {};
};

/// All bindings in the order of the help. An action may have several; some have none in a map.
std::span<const KeyBinding> key_bindings(KeyMap map = KeyMap::level);

/// The action of a key: of the binding with these modifiers, else, without Control, of the one with none.
std::optional<Action> action_of(bool mouse, int code, Modifiers held, KeyMap map = KeyMap::level);

/// A row of the help: consecutive bindings with one description.
struct HelpRow {
  KeyGroup group;
  std::string keys;  ///< "W A S D"
  std::string does;
};
std::vector<HelpRow> help_rows(KeyMap map = KeyMap::level);

}  // namespace brume::viewer
