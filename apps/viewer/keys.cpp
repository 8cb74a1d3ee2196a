#include "apps/viewer/keys.hpp"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>

#include "apps/viewer/session.hpp"

namespace brume::viewer {
namespace {

constexpr const char *kWalks = "walk; in flight, along the view", *kRuns = "run; in flight, down";
constexpr const char* kGlides = "glide along the view, and across it";
constexpr const char* kShapes = "shoot bullets, letters, word, image";
constexpr Modifiers kShift{true, false}, kControl{false, true}, kControlShift{true, true};

}  // namespace

const char* name_of(KeyGroup group) {
  constexpr std::array kNames{"Move", "Act", "Time", "View", "Files"};
  return kNames[static_cast<std::size_t>(group)];
}

namespace {

std::span<const KeyBinding> level_bindings() {
  using enum KeyGroup;
  static constexpr std::array kBindings{
      KeyBinding{Action::forward, move, false, GLFW_KEY_W, "W", kWalks},
      KeyBinding{Action::left, move, false, GLFW_KEY_A, "A", kWalks},
      KeyBinding{Action::back, move, false, GLFW_KEY_S, "S", kWalks},
      KeyBinding{Action::right, move, false, GLFW_KEY_D, "D", kWalks},
      KeyBinding{Action::up, move, false, GLFW_KEY_SPACE, "Space", "jump; in flight, up"},
      KeyBinding{Action::down, move, false, GLFW_KEY_LEFT_SHIFT, "Shift", kRuns},
      KeyBinding{Action::down, move, false, GLFW_KEY_RIGHT_SHIFT, "Shift", kRuns},
      KeyBinding{Action::fly, move, false, GLFW_KEY_G, "G", "fly, or walk"},
      KeyBinding{Action::steer_carrier, move, false, GLFW_KEY_C, "C", "steer the carrier (also Esc: end)"},
      KeyBinding{Action::add_key, move, false, GLFW_KEY_K, "K", "add a key of the carrier where it is now"},
      KeyBinding{kThrowSmoke, act, true, GLFW_MOUSE_BUTTON_LEFT, "Mouse left", "throw a smoke grenade"},
      KeyBinding{kShoot, act, true, GLFW_MOUSE_BUTTON_RIGHT, "Mouse right", "shoot"},
      KeyBinding{Action::shape_bullet, act, false, GLFW_KEY_1, "1", kShapes},
      KeyBinding{Action::shape_glyph, act, false, GLFW_KEY_2, "2", kShapes},
      KeyBinding{Action::shape_word, act, false, GLFW_KEY_3, "3", kShapes},
      KeyBinding{Action::shape_picture, act, false, GLFW_KEY_4, "4", kShapes},
      KeyBinding{kUseDoor, act, false, GLFW_KEY_F, "F", "open or close the nearest door"},
      KeyBinding{Action::probe, act, false, GLFW_KEY_L, "L", "line of sight: one end, then the other"},
      // Consecutive keys with one description are one row of the help, which names each label once.
      KeyBinding{Action::undo, act, false, GLFW_KEY_Z, "Ctrl+Z", "undo action or setting", kControl},
      KeyBinding{Action::redo, act, false, GLFW_KEY_Y, "Ctrl+Y", "redo (also Ctrl+Shift+Z)", kControl},
      KeyBinding{Action::redo, act, false, GLFW_KEY_Z, "Ctrl+Y", "redo (also Ctrl+Shift+Z)", kControlShift},
      KeyBinding{Action::pause, time, false, GLFW_KEY_P, "P", "pause or resume"},
      KeyBinding{Action::step_back, time, false, GLFW_KEY_COMMA, ",", "one tick back"},
      KeyBinding{Action::step_on, time, false, GLFW_KEY_PERIOD, ".", "one tick forward"},
      KeyBinding{Action::rewind, time, false, GLFW_KEY_R, "R", "to the start; actions happen again"},
      KeyBinding{Action::empty, time, false, GLFW_KEY_R, "Shift+R", "to the start; your actions are removed",
                 kShift},
      KeyBinding{Action::panels, view, false, GLFW_KEY_TAB, "Tab", "settings and time line"},
      KeyBinding{Action::free_cursor, view, true, GLFW_MOUSE_BUTTON_MIDDLE, "Mouse middle",
                 "hold: a cursor to aim with"},
      KeyBinding{Action::toggle_cursor, view, false, GLFW_KEY_ESCAPE, "Esc",
                 "the mouse moves a cursor, or the view"},
      KeyBinding{Action::next_view, view, false, GLFW_KEY_V, "V", "next debug view"},
      KeyBinding{Action::decals, view, false, GLFW_KEY_B, "B", "show or hide the decals"},
      KeyBinding{Action::overlay, view, false, GLFW_KEY_O, "O", "show or hide text and marks"},
      KeyBinding{Action::full_screen, view, false, GLFW_KEY_F11, "F11", "full screen"},
      KeyBinding{Action::help, view, false, GLFW_KEY_H, "H", "this help; pauses"},
      KeyBinding{Action::screenshot, files, false, GLFW_KEY_F12, "F12", "save a screenshot and its timeline"},
      KeyBinding{Action::save_recording, files, false, GLFW_KEY_F5, "F5", "save the session as a timeline"},
  };
  return kBindings;
}

/// The same with the keys of weapons.
std::vector<KeyBinding> with_weapons(std::span<const KeyBinding> bindings) {
  std::vector<KeyBinding> all(bindings.begin(), bindings.end());
  for_each_weapon([&](const WeaponEvent& weapon, auto) {
    if (!weapon.key) return;
    const KeyBinding binding{
        event_action(weapon.type), KeyGroup::act, false, weapon.key[0], weapon.key, weapon.does};
    all.insert(std::ranges::find(all, kUseDoor, &KeyBinding::action), binding);
  });
  return all;
}

std::span<const KeyBinding> tank_bindings() {
  using enum KeyGroup;
  static constexpr std::array kBindings{
      KeyBinding{Action::orbit, move, true, GLFW_MOUSE_BUTTON_LEFT, "Mouse left",
                 "drag: around the tank; a light, or the glass, by its mark"},
      KeyBinding{Action::pan, move, true, GLFW_MOUSE_BUTTON_RIGHT, "Mouse right", "drag: aside"},
      // The middle button pans, too: one row of the help, under one label.
      KeyBinding{Action::pan, move, true, GLFW_MOUSE_BUTTON_MIDDLE, "Mouse right", "drag: aside"},
      KeyBinding{Action::forward, move, false, GLFW_KEY_W, "W", kGlides},
      KeyBinding{Action::left, move, false, GLFW_KEY_A, "A", kGlides},
      KeyBinding{Action::back, move, false, GLFW_KEY_S, "S", kGlides},
      KeyBinding{Action::right, move, false, GLFW_KEY_D, "D", kGlides},
      KeyBinding{Action::up, move, false, GLFW_KEY_SPACE, "Space", "up"},
      KeyBinding{Action::down, move, false, GLFW_KEY_LEFT_SHIFT, "Shift", "down"},
      KeyBinding{Action::down, move, false, GLFW_KEY_RIGHT_SHIFT, "Shift", "down"},
      KeyBinding{Action::home, move, false, GLFW_KEY_HOME, "Home", "where the camera of the scene is"},
      KeyBinding{Action::camera_path, move, false, GLFW_KEY_C, "C", "follow the camera's path, or not"},
      KeyBinding{Action::focus, act, false, GLFW_KEY_F, "F", "focus on the middle of the view"},
      KeyBinding{Action::undo, act, false, GLFW_KEY_Z, "Ctrl+Z", "undo a setting", kControl},
      KeyBinding{Action::redo, act, false, GLFW_KEY_Y, "Ctrl+Y", "redo (also Ctrl+Shift+Z)", kControl},
      KeyBinding{Action::redo, act, false, GLFW_KEY_Z, "Ctrl+Y", "redo (also Ctrl+Shift+Z)", kControlShift},
      KeyBinding{Action::pause, time, false, GLFW_KEY_P, "P", "play or pause"},
      KeyBinding{Action::rewind, time, false, GLFW_KEY_R, "R", "to the start"},
      KeyBinding{Action::panels, view, false, GLFW_KEY_TAB, "Tab", "settings and time line"},
      KeyBinding{Action::close_popup, view, false, GLFW_KEY_ESCAPE, "Esc", "close a list or picker"},
      KeyBinding{Action::next_view, view, false, GLFW_KEY_V, "V", "spheres, or voxels"},
      KeyBinding{Action::overlay, view, false, GLFW_KEY_O, "O", "show or hide text and marks"},
      KeyBinding{Action::full_screen, view, false, GLFW_KEY_F11, "F11", "full screen"},
      KeyBinding{Action::help, view, false, GLFW_KEY_H, "H", "this help"},
      KeyBinding{Action::screenshot, files, false, GLFW_KEY_F12, "F12", "save the picture and its scene"},
      KeyBinding{Action::save_recording, files, false, GLFW_KEY_F5, "F5", "save the scene"},
      KeyBinding{Action::save_tank, files, false, GLFW_KEY_F6, "F6", "save the tank's spheres"},
  };
  return kBindings;
}

}  // namespace

std::span<const KeyBinding> key_bindings(KeyMap map) {
  static const std::vector<KeyBinding> kLevel = with_weapons(level_bindings());
  return map == KeyMap::tank ? tank_bindings() : kLevel;
}

std::optional<Action> action_of(bool mouse, int code, Modifiers held, KeyMap map) {
  std::optional<Action> plain;
  for (const KeyBinding& binding : key_bindings(map)) {
    if (binding.mouse != mouse || binding.code != code) continue;
    if (binding.modifiers == held) return binding.action;
    if (binding.modifiers == Modifiers{} && !held.control) plain = binding.action;
  }
  return plain;
}

std::vector<HelpRow> help_rows(KeyMap map) {
  std::vector<HelpRow> rows;
  const char* last_name = "";
  for (const KeyBinding& binding : key_bindings(map)) {
    const bool same = !rows.empty() && rows.back().group == binding.group && rows.back().does == binding.does;
    if (!same) rows.push_back({binding.group, binding.name, binding.does});
    if (same && last_name != std::string(binding.name)) rows.back().keys += std::string(" ") + binding.name;
    last_name = binding.name;
  }
  return rows;
}

}  // namespace brume::viewer
