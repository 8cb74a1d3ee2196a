// Key and mouse bindings: one table for input handling, the help and the documentation.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/events.hpp"

namespace brume::viewer {

/// Commands of the player; behind them, an action for each kind of event (event_action).
enum class Action {
  forward,
  back,
  left,
  right,
  up,
  down,
  free_cursor,
  toggle_cursor,
  fly,
  steer_carrier,
  add_key,
  shape_bullet,
  shape_glyph,
  shape_word,
  shape_picture,
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
/// The type of an event in timelines by its place among the kinds; null: there are no more.
constexpr const char* event_type(std::size_t kind) {
  const char* found = nullptr;
  scene::for_each_event_kind([&](const char* type, auto) {
    if (kind-- == 0) found = type;
  });
  return found;
}
constexpr std::size_t count_event_kinds() {
  std::size_t count = 0;
  while (event_type(count)) ++count;
  return count;
}
constexpr std::size_t kCommands = static_cast<std::size_t>(Action::count);
constexpr std::size_t kActions = kCommands + count_event_kinds();

/// The action that adds an event to the timeline, by the event's type there, which must be one.
constexpr Action event_action(std::string_view type) {
  std::size_t kind = 0;
  while (event_type(kind) != type) ++kind;
  return static_cast<Action>(kCommands + kind);
}
/// The type of the event that an action adds; null: it is a command.
constexpr const char* event_type(Action action) {
  const auto i = static_cast<std::size_t>(action);
  return i < kCommands ? nullptr : event_type(i - kCommands);
}
/// What the player does with events in a way of their own.
constexpr Action kThrowSmoke = event_action("smoke"), kShoot = event_action("shot"),
                 kUseDoor = event_action("door");

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
